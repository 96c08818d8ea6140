#include "research/validation/worlds/world_planners.h"

#include <array>

#include "research/validation/worlds/world_soils.h"

namespace slipway::validation {
namespace {

// All ground is taken for the firmest soil, for sure, so that tilt alone closes a way and time is length.
void plan_shortest(planner::PlanProblem& problem) {
  const sim::SoilDistribution firm = soil_of_class(kWorldSoils - 1, 0.0);
  for (sim::SoilDistribution& belief : problem.beliefs.known) belief = firm;
  problem.beliefs.unknown = firm;
  for (std::size_t row = 0; row < problem.weights.terms().size(); ++row)
    problem.weights[row] = problem.weights.terms()[row].name == "duration" ? 1.0 : 0.0;
}

void plan_as_given(planner::PlanProblem& /*problem*/) {}

void plan_by_cvar(planner::PlanProblem& problem) {
  problem.ranking.by = planner::RankBy::kCvar;
}

}  // namespace

std::span<const WorldPlanner> world_planners() {
  static constexpr std::array kPlanners{
      WorldPlanner{"shortest", "the shortest way within the limit of tilt; it knows nothing of soils",
                   &plan_shortest},
      WorldPlanner{"mean", "the least expected cost, by the weights that are set without a request",
                   &plan_as_given},
      WorldPlanner{"cvar", "the least mean cost of the worst tenth of the draws, by the same weights",
                   &plan_by_cvar},
  };
  return kPlanners;
}

}  // namespace slipway::validation
