#pragma once

#include <limits>

#include "core/angle.h"

namespace slipway::sim {

// A limit that nobody has set.
inline constexpr double kNoLimit = std::numeric_limits<double>::infinity();

// Limits that must hold along a drive; rule_catalogue.h has a row for each. A prediction does not stop where
// one is broken, but reports the place.
struct DriveLimits {
  double max_slip_ratio = 0.4;  // MER operations stopped drives at 40 %
  double max_tilt_rad = rad_from_deg(25.0);
  double max_pitch_rad = kNoLimit;       // without sign
  double max_roll_rad = kNoLimit;        // without sign
  double max_suspension_rad = kNoLimit;  // of any rocker or bogie, without sign
  double max_current_a = 10.0;           // of any wheel's motor
  double max_sinkage_m = 0.08;           // of any wheel
  double min_clearance_m = 0.0;          // of the belly over the ground
  // Over a stretch between checks. Of Curiosity's stretches of 5 m at Marias Pass 99 % slid by less than 12.7
  // deg, of those of sols 45 to 582 by less than 2.8 deg (measured by visual odometry, MSL SPICE kernels).
  double max_side_slip_rad = rad_from_deg(12.0);
  // Way to the side between two checks, each of which tells the rover where it is. Assumed: a rover's width.
  double max_aside_m = 2.0;
  double max_drive_s = kNoLimit;   // of a sol's drive
  double max_energy_j = kNoLimit;  // of the drive motors, in a sol's drive
};

// How the rover watches itself on the way. Documented operations: checks of the slip every 5 m with a limit
// of 40 % for the Mars Exploration Rovers, of 60 to 70 % at other times; data/rules has presets.
struct SlipChecks {
  double slip_check_every_m = 5.0;  // of way that the wheels roll
  // At a slip over this the wheels dig rather than drive.
  double embedding_slip_ratio = 0.9;
  // Turns of the wheels in one place, without a check between them that halts the rover, that embed it.
  // Opportunity's wheels turned some 60 times at Purgatory, and it was.
  double embedding_turns = 10.0;
  double embedding_sinkage_share = 0.75;  // of a wheel's radius, deeper than which the rover is embedded
};

}  // namespace slipway::sim
