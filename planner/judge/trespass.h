#pragma once

#include <vector>

#include "planner/problem/decision.h"
#include "planner/problem/motion.h"
#include "planner/problem/problem.h"

namespace slipway::planner {

// Turns the decision into a NO-GO, and says where, if the rover's body enters a keep-out of the problem or
// leaves a keep-in on its way. The motions are by the body's heading, forwards or backwards; the test is
// exact, see KeepOut.
void forbid_trespass(const PlanProblem& problem, const std::vector<Motion>& motions, DriveDecision& decision);

}  // namespace slipway::planner
