#pragma once

#include <optional>
#include <string>
#include <vector>

#include "planner/problem/drive_step.h"
#include "planner/problem/dynamic_verification.h"
#include "planner/problem/ranking.h"
#include "planner/problem/verdict.h"
#include "sim/prediction/drive_prediction.h"

namespace slipway::planner {

// One term of a route's cost.
struct CostShare {
  std::string name;    // of the cost catalogue
  double value = 0.0;  // in the term's unit, in the mean of the draws by which the route is ranked
  std::string unit;
  double weight = 0.0;
  double cost = 0.0;  // weight * value
};

struct Route {
  int rank = 0;         // 1 is best
  std::string planner;  // that proposed it
  std::string profile;  // what the search was asked to minimise ("balanced", "shortest", ...)
  sim::DrivePrediction prediction;
  std::optional<DynamicVerification> dynamic;  // where it was verified
  DriveSteps commands;                         // how it is driven; the prediction is of these
  std::vector<WeightedCost> drawn_costs;       // by the number of the draw
  double expected_cost = 0.0;                  // the mean of the draws' costs
  double cvar_cost = 0.0;                      // the mean of the dearest of them, see Ranking
  double cost = 0.0;                           // the one of the two by which the route is ranked
  std::vector<CostShare> shares;               // add up to cost
  DriveVerdict decision;
  bool pareto = false;               // no other route of the plan dominates it, see dominates()
  std::vector<std::string> reasons;  // why it is judged so and ranked so, in words and numbers

  Verdict verdict() const { return decision.verdict; }
};

// What a scout drive onto the ground that decides the best route is worth to the choice between the routes.
struct PlanScout {
  int route = 0;             // whose scout drive it is, by rank
  double worth = 0.0;        // expected drop of the cost of the route that is taken
  double other_route = 0.0;  // probability that another route is then the cheapest
};

struct Plan {
  std::vector<Route> routes;  // by rank
  std::optional<PlanScout> scout;
  std::vector<std::string> fewer_because;  // why there are fewer than asked for; empty otherwise
  int candidates = 0;                      // proposed by the planners before selection
  // Nothing was planned: the terrain is a part of a larger map, and no way is within it, or the best one
  // keeps to its edge.
  bool needs_wider_terrain = false;
};

}  // namespace slipway::planner
