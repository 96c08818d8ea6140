#pragma once

#include <vector>

#include "planner/problem/problem.h"
#include "planner/problem/route.h"

namespace slipway::planner {

// Cost, shares and verdict from a prediction, rows of the cost catalogue.
void judge(const PlanProblem& problem, Route& route);

// a before b: routes without a broken limit first, then by cost.
bool ranks_before(const Route& a, const Route& b);

// Numbers the routes, which are in their order, and says of each why it stands there and why it is judged so.
void explain(std::vector<Route>& routes);

}  // namespace slipway::planner
