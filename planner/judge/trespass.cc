#include "planner/judge/trespass.h"

#include <fmt/format.h>

#include "planner/problem/keep_out.h"

namespace slipway::planner {

void forbid_trespass(const PlanProblem& problem, const std::vector<Motion>& motions,
                     DriveDecision& decision) {
  const KeepOut zones(problem.keep_out, *problem.rover, problem.keep_in);
  const auto pose = first_hit(zones, motions);
  if (!pose) return;
  decision.decision = Decision::kNoGo;
  decision.reasons.insert(decision.reasons.begin(),
                          fmt::format("the rover's body would {} at ({:.2f}, {:.2f})",
                                      trespass_in_words(problem), pose->x_m, pose->y_m));
}

}  // namespace slipway::planner
