// A scene that every planner that is aware of risk must get right: a crust on a slope lies in the way. It is
// strong with a probability of 85 %, and with 15 % so weak that the rover slips to a stop on it. The mean of
// the draws crosses it, since the way round takes longer; the mean of the worst tenth of them goes round.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/angle.h"
#include "tests/full_size.h"
#include "tests/planner/ground_fixture.h"

namespace slipway::planner {
namespace {

constexpr int kCells = 48;
constexpr double kWestEdge_m = 18.0, kEastEdge_m = 30.0;

struct Patch {
  double south_m = 0.0, north_m = 0.0;
};

sim::SoilDistribution crust() {
  const sim::SoilDistribution strong = firm_soil("strong_crust");
  sim::SoilDistribution weak = firm_soil("weak_crust");
  weak.mean.cohesion_pa = 600.0;
  weak.mean.friction_angle_rad = 0.44;
  weak.std = {};
  sim::SoilDistribution belief = firm_soil("crust");
  for (const auto& [soil, probability] : {std::pair{strong, 0.85}, std::pair{weak, 0.15}})
    belief.alternatives.push_back(
        {soil.name, std::make_shared<const sim::SoilDistribution>(soil), probability, probability});
  return belief;
}

// The slope rises to the east, along the way from start to goal.
PlanProblem scene(double slope_deg, const Patch& patch, const Ranking& ranking) {
  PlanProblem problem = problem_on(kCells, kCells, 1.0, 1.0,
                                   [&](double x, double) { return x * std::tan(rad_from_deg(slope_deg)); });
  const dem::GridGeometry g = problem.terrain->geometry();
  std::vector<std::int16_t> soil;
  for (int row = 0; row < kCells; ++row) {
    for (int column = 0; column < kCells; ++column) {
      const Eigen::Vector2d place = g.centre_m({row, column});
      const bool in_patch = place.x() > kWestEdge_m && place.x() < kEastEdge_m && place.y() > patch.south_m &&
                            place.y() < patch.north_m;
      soil.push_back(in_patch ? 1 : 0);
    }
  }
  const std::size_t cells = soil.size();
  problem.soil_map =
      std::make_shared<dem::SoilMap>(g, std::move(soil), std::vector<std::uint8_t>(cells, 1),
                                     std::vector<dem::SoilClass>{{0, "a", "firm"}, {1, "c", "crust"}});
  problem.beliefs.known = {firm_soil("firm"), crust()};
  problem.start = {7.0, 24.0, 0.0};
  problem.goal = {41.0, 24.0, std::nullopt};
  problem.routes = 2;
  problem.risk.draws = 64;
  // To cross is no NO-GO here, beside which no other would be given out: the scene is of the ranking.
  problem.risk.bars = {.max_stop = 1.0, .no_go_stop = 1.0, .max_immobilised = 1.0, .max_embedding = 1.0};
  problem.ranking = ranking;
  // The detour takes some two minutes: crossing pays where these are dear enough against a stop.
  problem.weights.set("duration", 100.0);
  problem.weights.set("stops", 0.4);
  problem.weights.set("embedding", 10.0);
  return problem;
}

constexpr Patch kPatch{17.0, 31.0};
const Ranking kByMean{RankBy::kExpected, 0.1}, kByTail{RankBy::kCvar, 0.1};

double on_crust_m(const Route& route) {
  double length = 0.0;
  const auto& stations = route.prediction.stations;
  for (std::size_t k = 1; k < stations.size(); ++k)
    if (stations[k].soil == std::size_t{1})
      length += stations[k].station.distance_m - stations[k - 1].station.distance_m;
  return length;
}

// y half way.
double half_way_m(const Route& route) {
  for (const sim::StationPrediction& s : route.prediction.stations)
    if (s.station.pose.x_m >= 24.0) return s.station.pose.y_m;
  return std::nan("");
}

TEST(RiskAwareScene, TheWeakCrustHoldsTheRoverAndTheStrongOneDoesNot) {
  PlanProblem problem = scene(12.0, kPatch, kByMean);
  NoProgress progress;
  const auto line = predict_path(problem, {problem.start, problem.goal}, progress);
  ASSERT_TRUE(line);
  ASSERT_FALSE(line->immobilised);
  int held = 0, passed = 0;
  for (const sim::DrawFigures& draw : line->drawn) (draw.stops > 0 || draw.embedded ? held : passed)++;
  EXPECT_NEAR(held / 64.0, 0.15, 0.1);
  EXPECT_EQ(held + passed, 64);
}

TEST(RiskAwareScene, TheMeanCrossesTheCrustAndTheTailGoesRound) {
  for (std::uint64_t seed = 1; seed <= (full_size() ? 2U : 1U); ++seed) {
    PlanProblem by_mean = scene(12.0, kPatch, kByMean), by_tail = scene(12.0, kPatch, kByTail);
    by_mean.risk.seed = by_tail.risk.seed = seed;
    const Plan crosses = plan_on(by_mean), round = plan_on(by_tail);
    ASSERT_FALSE(crosses.routes.empty());
    ASSERT_FALSE(round.routes.empty());
    EXPECT_GT(on_crust_m(crosses.routes[0]), 10.0) << seed;
    EXPECT_LT(on_crust_m(round.routes[0]), 2.5) << seed;  // a corner at most
    EXPECT_LT(round.routes[0].cvar_cost, crosses.routes[0].cvar_cost) << seed;
    EXPECT_LT(crosses.routes[0].expected_cost, round.routes[0].expected_cost) << seed;
  }
}

TEST(RiskAwareScene, AMirroredPatchIsPassedOnTheMirroredSide) {
  // Nearer to the way's one side than to its other.
  const Patch to_north{20.0, 34.0}, to_south{48.0 - 34.0, 48.0 - 20.0};
  const Plan north = plan_on(scene(12.0, to_north, kByTail)), south = plan_on(scene(12.0, to_south, kByTail));
  ASSERT_FALSE(north.routes.empty());
  ASSERT_FALSE(south.routes.empty());
  EXPECT_LT(half_way_m(north.routes[0]), 20.0);
  EXPECT_GT(half_way_m(south.routes[0]), 28.0);
  EXPECT_NEAR(north.routes[0].cvar_cost, south.routes[0].cvar_cost, 0.05 * north.routes[0].cvar_cost);
}

TEST(RiskAwareScene, OnLevelUniformGroundBothGiveTheSameRoute) {
  const Patch none{0.0, 0.0};
  const Plan by_mean = plan_on(scene(0.0, none, kByMean)), by_tail = plan_on(scene(0.0, none, kByTail));
  ASSERT_FALSE(by_mean.routes.empty());
  ASSERT_FALSE(by_tail.routes.empty());
  for (const Plan* const plan : {&by_mean, &by_tail})
    for (const sim::StationPrediction& s : plan->routes[0].prediction.stations)
      EXPECT_NEAR(s.station.pose.y_m, 24.0, 0.5);
}

}  // namespace
}  // namespace slipway::planner
