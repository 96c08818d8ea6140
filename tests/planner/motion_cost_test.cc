#include "planner/search/motion_cost.h"

#include <gtest/gtest.h>

#include <numbers>

#include "core/angle.h"
#include "dem/synthetic_terrain.h"
#include "planner/search/grid_search.h"
#include "tests/planner/plan_fixture.h"

namespace slipway::planner {
namespace {

// A search's view of one terrain, with all that it points to.
struct World {
  explicit World(PlanProblem asked)
      : problem(std::move(asked)),
        keep_out(problem.keep_out, *problem.rover),
        tables(build_ground_tables(problem)),
        map(problem, keep_out, problem.terrain->geometry().extent()),
        cost(problem, map, tables, problem.weights) {}
  PlanProblem problem;
  KeepOut keep_out;
  GroundTables tables;
  TraverseMap map;
  MotionCost cost;
};

// Rises to the east; firm ground all over.
PlanProblem ramp(double slope_deg) {
  PlanProblem problem = problem_of("S . .\n. . .\n. . G\n");
  problem.terrain = dem::make_ramp({.size_m = 40.0, .cell_m = 1.0}, rad_from_deg(slope_deg), 0.0);
  const dem::GridGeometry g = problem.terrain->geometry();
  const auto cells = static_cast<std::size_t>(g.rows) * static_cast<std::size_t>(g.columns);
  problem.soil_map = std::make_shared<dem::SoilMap>(g, std::vector<std::int16_t>(cells, 0),
                                                    std::vector<std::uint8_t>(cells, 1),
                                                    std::vector<dem::SoilClass>{{0, "a", "firm"}});
  problem.beliefs.known = {firm_soil("firm")};
  return problem;
}

TEST(MotionCost, DependsOnTheHeadingOnASlopeAndNotOnTheLevel) {
  const World slope(ramp(14.0));
  const double up = slope.cost.per_metre({0.0, 0.0, 0.0});
  const double down = slope.cost.per_metre({0.0, 0.0, std::numbers::pi});
  const double across = slope.cost.per_metre({0.0, 0.0, 0.5 * std::numbers::pi});
  EXPECT_GT(up, 1.02 * down);
  EXPECT_GT(std::abs(across - up), 0.01 * up);
  const World level(ramp(0.0));
  EXPECT_NEAR(level.cost.per_metre({0.0, 0.0, 0.0}), level.cost.per_metre({0.0, 0.0, 1.0}), 1e-9);
}

TEST(MotionCost, AgreesWithTheSlipTableOnTheCataloguesSum) {
  World world(ramp(10.0));
  Weights only_slip;
  for (const CostTerm& term : only_slip.terms()) only_slip.set(term.name, term.name == "slip" ? 4.0 : 0.0);
  const MotionCost cost(world.problem, world.map, world.tables, only_slip);
  const double slip = world.tables.known[0]->mean.at(-rad_from_deg(10.0), 0.0)->slip_ratio;
  EXPECT_NEAR(cost.per_metre({0.0, 0.0, 0.0}), 4.0 * slip / 100.0, 0.05 * 4.0 * slip / 100.0);
}

TEST(MotionCost, OfAMotionIsItsLengthTimesTheCostPerMetreOnEvenGround) {
  const World world(ramp(8.0));
  const Motion motion = straight({-5.0, 2.0, 0.0}, 5.0, 2.0);
  EXPECT_NEAR(world.cost.of(motion), 10.0 * world.cost.per_metre({0.0, 0.0, 0.0}), 1e-9);
  // Around a quarter circle every heading's cost takes part.
  const Motion arc = connect({0.0, 0.0, 0.0}, {5.0, 5.0, 0.5 * std::numbers::pi}, world.cost.limits());
  double sum = 0.0;
  for (int k = 0; k < 1000; ++k)
    sum +=
        arc.length_m / 1000.0 * world.cost.per_metre({0.0, 0.0, (k + 0.5) / 1000.0 * 0.5 * std::numbers::pi});
  EXPECT_NEAR(world.cost.of(arc), sum, 0.01 * sum);
}

TEST(MotionCost, IsInfiniteBeyondTheTiltLimitAndOffTheMap) {
  const World steep(ramp(27.0));
  EXPECT_TRUE(std::isinf(steep.cost.per_metre({0.0, 0.0, 0.0})));
  const World level(ramp(0.0));
  EXPECT_TRUE(std::isinf(level.cost.per_metre({19.8, 0.0, 0.0})));
  EXPECT_TRUE(std::isinf(level.cost.of(straight({0.0, 0.0, 0.0}, 30.0, 0.0))));
}

TEST(MotionCost, UnknownGroundIsDearerThanTheSameGroundKnown) {
  PlanProblem problem = ramp(5.0);
  problem.beliefs.unknown = problem.beliefs.known[0];
  const World known(problem);
  problem.soil_map = nullptr;
  const World unknown(problem);
  EXPECT_GT(unknown.cost.per_metre({0.0, 0.0, 0.0}), known.cost.per_metre({0.0, 0.0, 0.0}) + 0.019);
}

TEST(GridSearch, CostToGoAndCostToComeAgreeAndNearlyTheStraightLine) {
  const World world(ramp(6.0));
  const GridSearch grid(world.cost);
  const auto start = static_cast<std::size_t>(world.map.index_at(-10.5, -3.5));
  const auto goal = static_cast<std::size_t>(world.map.index_at(9.5, 6.5));
  const float to_go = grid.cost_to_go(9.5, 6.5).cost[start];
  const float to_come = grid.cost_to_come(-10.5, -3.5).cost[goal];
  EXPECT_NEAR(to_go, to_come, 1e-4 * to_go);
  const Motion direct = straight({-10.5, -3.5, std::atan2(10.0, 20.0)}, 9.5, 6.5);
  EXPECT_NEAR(to_go, world.cost.of(direct), 0.02 * to_go);
}

TEST(TraverseMap, KeepsItsCellsBoundedOnALargeTerrain) {
  PlanProblem problem = ramp(3.0);
  problem.terrain = dem::make_ramp({.size_m = 2000.0, .cell_m = 1.0}, rad_from_deg(3.0), 0.0);
  const KeepOut keep_out({}, *problem.rover);
  const TraverseMap map(problem, keep_out, problem.terrain->geometry().extent());
  EXPECT_LE(map.cells(), static_cast<std::size_t>(kMaxSearchCells));
  EXPECT_NEAR(map.cell(map.cells() / 2 + 700).gradient_x, std::tan(rad_from_deg(3.0)), 1e-3);
}

}  // namespace
}  // namespace slipway::planner
