// Every direction of the compass is as good as any other on flat ground.
#include <gtest/gtest.h>

#include <cmath>

#include "core/angle.h"
#include "dem/synthetic_terrain.h"
#include "planner/make_plan.h"
#include "tests/planner/plan_fixture.h"

namespace slipway::planner {
namespace {

constexpr double kAway_m = 15.0;

PlanProblem flat() {
  PlanProblem problem = problem_of("S . .\n. . .\n. . G\n");
  problem.terrain = dem::make_plane({.size_m = 60.0, .cell_m = 1.0}, 0.0);
  problem.soil_map = nullptr;
  problem.start = {0.0, 0.0, std::nullopt};
  problem.goal = {kAway_m, 0.0, std::nullopt};
  problem.routes = 1;
  problem.risk.draws = 1;
  return problem;
}

std::string fault_of(const PlanProblem& problem) {
  NoProgress progress;
  const Result<Plan> plan = make_plan(problem, progress);
  if (!plan) return plan.error().detail;
  if (plan->routes.empty()) return plan->fewer_because.at(0);
  return "";
}

class Rose : public testing::TestWithParam<std::string> {};

TEST_P(Rose, EveryBearingHasARoute) {
  PlanProblem problem = flat();
  problem.planners = {GetParam()};
  for (int deg = 0; deg < 360; deg += 15) {
    problem.goal.x_m = kAway_m * std::cos(rad_from_deg(deg));
    problem.goal.y_m = kAway_m * std::sin(rad_from_deg(deg));
    EXPECT_EQ(fault_of(problem), "") << deg;
  }
}

TEST_P(Rose, EveryHeadingOfStartAndGoalHasARoute) {
  PlanProblem problem = flat();
  problem.planners = {GetParam()};
  for (const double deg :
       {-180.0, -179.9, -135.0, -90.0, -45.0, 0.0, 45.0, 90.0, 135.0, 179.9, 180.0, 540.0}) {
    problem.goal.yaw_rad = std::nullopt;
    problem.start.yaw_rad = rad_from_deg(deg);
    EXPECT_EQ(fault_of(problem), "") << "start " << deg;
    problem.goal.yaw_rad = rad_from_deg(deg);
    problem.start.yaw_rad = std::nullopt;
    EXPECT_EQ(fault_of(problem), "") << "goal " << deg;
  }
}

INSTANTIATE_TEST_SUITE_P(EveryPlanner, Rose, testing::Values("rrt_star", "bit_star"),
                         [](const auto& row) { return row.param; });

}  // namespace
}  // namespace slipway::planner
