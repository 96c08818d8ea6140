#pragma once

#include <optional>

#include "sim/dynamic/drive_leg.h"

namespace slipway::sim {

struct DynamicOptions {
  double relative_tolerance = 1e-3;  // of CVODE, per step; absolute ones in proportion (rover_dynamics.h)
  Feedback feedback = Feedback::kNone;
  double sample_interval_s = 1.0;
  // Points under each wheel, along its travel, at which the ground is looked at: 1 is what the other rungs
  // do.
  int contact_points = 3;
  bool keep_ruts = false;  // all of them, for a deformed terrain; otherwise those near the rover
  // Immobilised: in this time, or on a whole leg, less than kLeastProgress of what was commanded; not judged
  // on less than half a wheel's radius of commanded way.
  double give_up_s = 60.0;
  std::optional<double> motor_temp_c = {};
};
constexpr double kLeastProgress = 0.02;

}  // namespace slipway::sim
