#pragma once

#include "core/progress.h"
#include "core/result.h"
#include "planner/problem/problem.h"
#include "planner/problem/route.h"

namespace slipway::planner {

// Proposes with OMPL, simulates, ranks, verifies the best in the dynamic rung and ranks again. "No route" is
// a Plan without routes whose fewer_because says why. Errors: off_map, no_data (start, goal or a waypoint;
// faults "/start", "/goal", "/waypoints/1"), invalid_request (start, goal or waypoint inside a keep-out or
// steeper than the limits allow; unknown planner), cancelled.
Result<Plan> make_plan(const PlanProblem& problem, Progress& progress);

}  // namespace slipway::planner
