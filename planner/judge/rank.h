#pragma once

#include <vector>

#include "planner/problem/problem.h"
#include "planner/problem/route.h"

namespace slipway::planner {

// Cost, shares, costs of the draws and verdict from a prediction, rows of the cost catalogue.
void judge(const PlanProblem& problem, Route& route);

// a before b: routes without a broken limit first, then by the cost that ranks them.
bool ranks_before(const Route& a, const Route& b);

// Whether a is better than b in duration, energy (on the mean soils), expected stops or probability of
// embedding, and worse in none of them. An immobilised route dominates none and is dominated by each that is
// not.
bool dominates(const Route& a, const Route& b);

// Marks the routes that no other dominates.
void mark_pareto_front(std::vector<Route>& routes);

// a's ranked cost less b's, over the draws that both have; no draws where one has none.
CostDifference ranked_difference(const Route& a, const Route& b, const Ranking& ranking);

// No further draws are needed to tell which of the two is ranked before the other.
bool clearly_apart(const Route& a, const Route& b, const Ranking& ranking);

// Numbers the routes, which are in their order, and says of each why it stands there and why it is judged so.
void explain(std::vector<Route>& routes, const Ranking& ranking = {});

}  // namespace slipway::planner
