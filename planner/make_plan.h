#pragma once

#include <span>

#include "core/progress.h"
#include "core/result.h"
#include "planner/problem/problem.h"
#include "planner/problem/route.h"
#include "planner/search/planner_catalogue.h"

namespace slipway::planner {

// Proposes routes with the planners of the catalogue, simulates, ranks, verifies the best in the dynamic
// simulation and ranks again. No station of a route, and no place between two of them, has the body in a
// keep-out. "No route" is a Plan without routes whose fewer_because says why. Errors: off_map, no_data
// (start, goal or a waypoint; faults "/start", "/goal", "/waypoints/1"), invalid_request (start, goal or
// waypoint inside a keep-out or steeper than the limits allow; unknown planner), cancelled.
Result<Plan> make_plan(const PlanProblem& problem, Progress& progress,
                       std::span<const PlannerRow> planners = planner_catalogue());

}  // namespace slipway::planner
