#pragma once

#include <string>
#include <vector>

#include "planner/problem/problem.h"
#include "planner/problem/route.h"

namespace slipway::planner {

// Cost, shares, costs of the draws and verdict from a prediction, rows of the cost catalogue.
void judge(const PlanProblem& problem, Route& route);
// The decision and the verdict alone: the costs stay those of other draws.
void judge_outcome(const PlanProblem& problem, Route& route);

// a before b: routes without a broken limit first, then by cost.
bool ranks_before(const Route& a, const Route& b);

// The places of routes in the order in which they are given out: by ranks_before(), those that are equal as
// they are.
std::vector<std::size_t> ranked_order(const std::vector<Route>& routes);

// What no operator commands: a limit is broken or the rover immobilised on the mean soils, the dynamic
// simulation refutes it, or the draws of the ground decide so.
bool is_no_go(const Route& route);

// Whether a is better than b in duration, energy (on the mean soils), expected stops or probability of
// embedding, and worse in none of them. An immobilised route dominates none and is dominated by each that is
// not.
bool dominates(const Route& a, const Route& b);

// Marks the routes that no other dominates.
void mark_pareto_front(std::vector<Route>& routes);

// a's ranked cost less b's, over the draws that both have; no draws where one has none.
CostDifference ranked_difference(const Route& a, const Route& b, const Ranking& ranking);

// What the draws say of the order of two routes.
enum class RankOrder {
  kTold,  // nought lies outside the 90 % interval of the difference of their costs, or no draws are needed
  kTied,  // nought lies in it, and the costs are within 3 % of each other
  kUndecided,  // nought lies in it, and the costs are further apart: more draws may tell
};
RankOrder order_of(const Route& a, const Route& b, const Ranking& ranking);

// Numbers the routes, which are in their order, and says of each why it stands there and why it is judged so.
void explain(std::vector<Route>& routes, const Ranking& ranking = {});

}  // namespace slipway::planner
