#include "api/steps/steps_near.h"

#include <algorithm>

#include "core/quantile.h"

namespace slipway::api {

std::optional<StepsNear> steps_near(std::span<const steps::SlipStep> steps, std::optional<int> as_of_sol,
                                    std::span<const Pose2> way) {
  StepsNear near;
  std::vector<double> slips;
  for (const steps::SlipStep& step : steps) {
    if (!step.x_eqc_m || !step.y_eqc_m || (as_of_sol && step.sol >= *as_of_sol)) continue;
    const bool is_near = std::any_of(way.begin(), way.end(), [&](const Pose2& at) {
      const double dx = at.x_m - *step.x_eqc_m, dy = at.y_m - *step.y_eqc_m;
      return dx * dx + dy * dy <= StepsNear::kWithin_m * StepsNear::kWithin_m;
    });
    if (!is_near) continue;
    slips.push_back(step.slip);
    near.way_m += step.odometry_m;
  }
  if (slips.empty()) return std::nullopt;
  near.steps = slips.size();
  near.median_slip = median(slips);
  near.largest_slip = *std::max_element(slips.begin(), slips.end());
  return near;
}

}  // namespace slipway::api
