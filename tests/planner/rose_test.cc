// Every direction of the compass is as good as any other on flat ground.
#include <gtest/gtest.h>

#include <cmath>

#include "core/angle.h"
#include "dem/synthetic_terrain.h"
#include "planner/make_plan.h"
#include "planner/search/grid_search.h"
#include "tests/full_size.h"
#include "tests/planner/plan_fixture.h"

namespace slipway::planner {
namespace {

constexpr double kAway_m = 15.0;

PlanProblem flat() {
  PlanProblem problem = problem_of("S . .\n. . .\n. . G\n");
  problem.terrain = dem::make_plane({.size_m = 60.0, .cell_m = 1.0}, 0.0);
  problem.soil_map = nullptr;
  problem.start = {0.0, 0.0, std::nullopt};
  problem.routes = 1;
  problem.risk.draws = 1;
  return problem;
}

// To the nanometre, so that due west is exactly west.
Waypoint goal_at(double bearing_deg) {
  const double angle = rad_from_deg(bearing_deg);
  return {std::round(1e9 * kAway_m * std::cos(angle)) / 1e9,
          std::round(1e9 * kAway_m * std::sin(angle)) / 1e9, std::nullopt};
}

// What every leg on the same ground shares.
struct World {
  PlanProblem problem = flat();
  KeepOut keep_out{problem.keep_out, *problem.rover};
  GroundTables tables = build_ground_tables(problem);
  TraverseMap map{problem, keep_out, problem.terrain->geometry().extent()};
  MotionCost cost{problem, map, tables, problem.weights};
  GridSearch grid{cost};
};

class Rose : public testing::TestWithParam<PlannerRow> {
 protected:
  static bool finds(const World& world, const Waypoint& goal, double start_rad, double arrival_rad) {
    const PoseSampler sampler(world.grid, world.map, world.grid.cost_to_come(0.0, 0.0),
                              world.grid.cost_to_go(goal.x_m, goal.y_m), 0.0, 0.0);
    LegSearch leg;
    leg.cost = &world.cost;
    leg.sampler = &sampler;
    leg.from = {0.0, 0.0, wrapped_rad(start_rad)};
    leg.to_x_m = goal.x_m;
    leg.to_y_m = goal.y_m;
    leg.arrival_rad = {wrapped_rad(arrival_rad)};
    leg.iterations = 300;
    return GetParam().make()->search(leg).size() >= 2;
  }
};

TEST_P(Rose, EveryBearingAndHeadingOfStartAndGoalHasARoute) {
  const World world;
  const Waypoint east = goal_at(0.0);
  for (int deg = -180; deg <= 180; deg += full_size() ? 15 : 45) {
    const double angle = rad_from_deg(deg);
    EXPECT_TRUE(finds(world, goal_at(deg), angle, angle)) << "bearing " << deg;
    EXPECT_TRUE(finds(world, east, angle, 0.0)) << "start " << deg;
    EXPECT_TRUE(finds(world, east, 0.0, angle)) << "goal " << deg;
  }
}

TEST_P(Rose, DueWestIsPlannedAsAnyOtherDirection) {
  const auto fault_of = [](const PlanProblem& problem) {
    NoProgress progress;
    const Result<Plan> plan = make_plan(problem, progress);
    if (!plan) return plan.error().detail;
    return plan->routes.empty() ? plan->fewer_because.at(0) : std::string();
  };
  PlanProblem problem = flat();
  problem.planners = {std::string(GetParam().name)};
  problem.goal = goal_at(180.0);
  EXPECT_EQ(fault_of(problem), "");
  problem.goal = goal_at(0.0);
  for (const double deg : {-180.0, 180.0}) {
    problem.start.yaw_rad = problem.goal.yaw_rad = rad_from_deg(deg);
    EXPECT_EQ(fault_of(problem), "") << deg;
  }
}

INSTANTIATE_TEST_SUITE_P(EveryPlanner, Rose,
                         testing::ValuesIn(planner_catalogue().begin(), planner_catalogue().end()),
                         [](const auto& row) { return std::string(row.param.name); });

}  // namespace
}  // namespace slipway::planner
