#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/pose.h"
#include "steps/slip_step.h"

namespace slipway::api {

// What was measured near a way.
struct StepsNear {
  static constexpr double kWithin_m = 5.0;
  std::size_t steps = 0;
  double way_m = 0.0;  // their length
  double median_slip = 0.0, largest_slip = 0.0;
};

// The measured steps that begin within kWithin_m of some place of a way, of the sols before `as_of_sol` where
// it is given; nothing where there are none.
std::optional<StepsNear> steps_near(std::span<const steps::SlipStep> steps, std::optional<int> as_of_sol,
                                    std::span<const Pose2> way);

}  // namespace slipway::api
