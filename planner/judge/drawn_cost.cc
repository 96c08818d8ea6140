#include "planner/judge/drawn_cost.h"

namespace slipway::planner {

void cost_draws(const PlanProblem& problem, Route& route) {
  const Ranking& ranking = problem.ranking;
  const std::vector<sim::DrawFigures>& drawn = route.prediction.drawn;
  route.drawn_costs.clear();
  if (drawn.empty()) {
    route.expected_cost = route.cvar_cost = route.cost;
    return;
  }
  std::vector<DriveFigures> figures;
  for (const sim::DrawFigures& draw : drawn) {
    figures.push_back(figures_of(route.prediction, draw));
    route.drawn_costs.push_back({problem.weights.cost(figures.back()), draw.weight});
  }
  route.expected_cost = conditional_value_at_risk(route.drawn_costs, 1.0);
  route.cvar_cost = conditional_value_at_risk(route.drawn_costs, ranking.tail);
  route.cost = ranking.by == RankBy::kCvar ? route.cvar_cost : route.expected_cost;
  const std::vector<double> weights = tail_weights(route.drawn_costs, ranking.ranked_tail());
  const std::span<const CostTerm> terms = problem.weights.terms();
  for (std::size_t row = 0; row < route.shares.size(); ++row) {
    CostShare& share = route.shares[row];
    share.value = 0.0;
    for (std::size_t d = 0; d < drawn.size(); ++d) share.value += weights[d] * terms[row].value(figures[d]);
    share.cost = share.weight * share.value;
  }
}

}  // namespace slipway::planner
