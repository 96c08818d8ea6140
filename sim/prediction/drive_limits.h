#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/angle.h"

namespace slipway::sim {

// What must hold along a drive. A prediction never stops at a limit; it says where it is broken.
struct DriveLimits {
  double max_slip_ratio = 0.4;  // MER operations stopped drives at 40 %
  double max_tilt_rad = rad_from_deg(25.0);
  double max_current_a = 10.0;   // of any wheel's motor
  double max_sinkage_m = 0.08;   // of any wheel
  double min_clearance_m = 0.0;  // of the belly over the ground
};

// A greatest value and where on the way it is.
struct Peak {
  double value = 0.0;
  double distance_m = 0.0;

  void raise(double other, double other_distance_m) {
    if (other > value) *this = {other, other_distance_m};
  }
};

// The extremes of a drive that limits are about.
struct DriveExtremes {
  Peak max_slip_ratio, max_tilt_rad, max_current_a, max_sinkage_m;
  std::optional<Peak> least_clearance_m = {};  // nothing where a rung does not look at the belly
};

// "slip 0.52 at 31.2 m, limit 0.4", one for each limit that is broken.
std::vector<std::string> broken_limits(const DriveExtremes& extremes, const DriveLimits& limits);

}  // namespace slipway::sim
