#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/result.h"
#include "sim/dynamic/drive_leg.h"

namespace slipway::sim {

struct DynamicOptions {
  // CVODE's relative tolerance per step, in [1e-10, 0.01]; the absolute tolerances are in proportion to it
  // (rover_dynamics.h).
  double relative_tolerance = 1e-3;
  Feedback feedback = Feedback::kNone;
  double sample_interval_s = 1.0;  // > 0
  // Points under each wheel along its travel at which the ground's height is read, in [1, 9]; the other
  // fidelity levels have one.
  int contact_points = 3;
  bool keep_ruts = false;  // true keeps all ruts, for a deformed terrain; false keeps those near the rover
  // The rover counts as immobilised where, within this time or on a whole leg, it makes less than
  // kMinProgress of the commanded distance. This is not judged before half a wheel's radius was commanded.
  double give_up_s = 60.0;
  std::optional<double> motor_temp_c = {};  // the motors' reference temperature where it is empty
};
constexpr double kMinProgress = 0.02;

// Everything that makes these legs or options unusable, with its place ("/legs/2", "/contact_points"); empty
// where there is nothing.
std::vector<Fault> faults_of(std::span<const DriveLeg> legs, const DynamicOptions& options);

}  // namespace slipway::sim
