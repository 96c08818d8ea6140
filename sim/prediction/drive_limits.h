#pragma once

#include <optional>
#include <string>
#include <string_view>
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

// How the rover watches itself on the way. Documented operations: checks of the slip every 5 m with a limit
// of 40 % for the Mars Exploration Rovers, of 60 to 70 % at other times; data/rules has presets.
struct SlipChecks {
  double slip_check_every_m = 5.0;  // of way that the wheels roll
  // At a slip over this the wheels dig rather than drive.
  double embedding_slip_ratio = 0.9;
  // Turns of the wheels at such a slip, without a check between them, that embed the rover. Opportunity's
  // wheels turned some 60 times at Purgatory, and it was; a check every 5 m lets them turn three to seven
  // times.
  double embedding_turns = 10.0;
  double embedding_sinkage_share = 0.75;  // of a wheel's radius, deeper than which the rover is embedded
};

// What may end a drive, or break a limit along it. Slip check, tilt and current stop the drive for a sol.
enum class Rule { kSlipCheck, kTilt, kCurrent, kSinkage, kClearance, kEmbedding };
inline constexpr std::size_t kRules = 6;

// "slip_check", "tilt", "current", "sinkage", "clearance", "embedding".
std::string_view describe(Rule rule);

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
