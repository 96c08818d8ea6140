#pragma once

#include <vector>

#include "planner/problem/problem.h"
#include "planner/problem/route.h"

namespace slipway::planner {

// Cost, shares, costs of the draws and verdict from a prediction, rows of the cost catalogue.
void judge(const PlanProblem& problem, Route& route);

// a before b by their figures: routes without a broken limit first, then by the cost that ranks them.
bool ranks_before(const Route& a, const Route& b);

// The places of routes in the order in which they are given out. First is the best by ranks_before() or, of
// those that the draws do not tell from it, the shortest: more draws or another seed change the costs of
// these within their intervals, and would change their order with them. Then the same of the others.
std::vector<std::size_t> ranked_order(const std::vector<Route>& routes, const Ranking& ranking);

// Whether a is better than b in duration, energy (on the mean soils), expected stops or probability of
// embedding, and worse in none of them. An immobilised route dominates none and is dominated by each that is
// not.
bool dominates(const Route& a, const Route& b);

// Marks the routes that no other dominates.
void mark_pareto_front(std::vector<Route>& routes);

// a's ranked cost less b's, over the draws that both have; no draws where one has none.
CostDifference ranked_difference(const Route& a, const Route& b, const Ranking& ranking);

// The draws tell which of the two is ranked before the other, at 99 %: by a chance of 10 % one of several
// seeds would often put the other one first.
bool clearly_apart(const Route& a, const Route& b, const Ranking& ranking);

// Numbers the routes, which are in their order, and says of each why it stands there and why it is judged so.
void explain(std::vector<Route>& routes, const Ranking& ranking = {});

}  // namespace slipway::planner
