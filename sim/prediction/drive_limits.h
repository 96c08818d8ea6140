#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/angle.h"

namespace slipway::sim {

// Limits that must hold along a drive. A prediction does not stop where one is broken, but reports the place.
struct DriveLimits {
  double max_slip_ratio = 0.4;  // MER operations stopped drives at 40 %
  double max_tilt_rad = rad_from_deg(25.0);
  double max_current_a = 10.0;   // of any wheel's motor
  double max_sinkage_m = 0.08;   // of any wheel
  double min_clearance_m = 0.0;  // of the belly over the ground
};

// A maximum and the distance along the drive at which it occurs.
struct Peak {
  double value = 0.0;
  double distance_m = 0.0;

  void raise(double other, double other_distance_m) {
    if (other > value) *this = {other, other_distance_m};
  }
};

// The extremes of a drive for which there are limits.
struct DriveExtremes {
  Peak max_slip_ratio, max_tilt_rad, max_current_a, max_sinkage_m;
  std::optional<Peak> least_clearance_m = {};  // empty where a fidelity level does not compute the clearance
};

// "slip 0.52 at 31.2 m, limit 0.4", one for each limit that is broken.
std::vector<std::string> broken_limits(const DriveExtremes& extremes, const DriveLimits& limits);

}  // namespace slipway::sim
