#pragma once

#include "planner/problem/problem.h"
#include "planner/problem/route.h"

namespace slipway::planner {

// Fills what a route costs in each draw, the figures of these costs and the terms of the one that ranks it,
// from its prediction. Where that has no draws, the costs are the one on the mean soils, which the route and
// its shares must have.
void cost_draws(const PlanProblem& problem, Route& route);

}  // namespace slipway::planner
