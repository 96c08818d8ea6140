#include "planner/search/grid_leg_planner.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/angle.h"
#include "planner/make_plan.h"
#include "planner/problem/keep_out.h"
#include "tests/planner/plan_fixture.h"

namespace slipway::planner {
namespace {

constexpr std::string_view kYard = R"(
. . . . . . . . . . . . . . . . . . . . . .
. . . . . . . . . . . . . . . . . . . . . .
. . . . . . . . . . . # . . . . . . . . . .
. . . . . . . . . . . # . . . . . . . . . .
. . . S . . . . . . . # . . . . . . . G . .
. . . . . . . . . . . # . . . . . . . . . .
. . . . . . . . . . . . . . . . . . . . . .
. . . . . . . . . . . . . . . . . . . . . .
. . . . . . . . . . . . . . . . . . . . . .
)";

Plan grid_plan(const PlanProblem& problem) {
  NoProgress progress;
  Result<Plan> plan = make_plan(problem, progress);
  EXPECT_TRUE(plan.has_value()) << plan.error().detail;
  return plan.value_or(Plan{});
}

TEST(GridPlanner, IsAskedForByNameAndDrivesMotionsOfTheRover) {
  PlanProblem problem = problem_of(kYard);
  problem.planners = {"grid"};
  problem.routes = 2;
  const Plan plan = grid_plan(problem);
  ASSERT_FALSE(plan.routes.empty());
  for (const Route& route : plan.routes) {
    EXPECT_EQ(route.planner, "grid");
    EXPECT_NE(route.verdict(), Verdict::kNoGo);
    const auto& stations = route.prediction.stations;
    EXPECT_NEAR(stations.back().station.pose.x_m, problem.goal.x_m, 0.05);
    for (const sim::StationPrediction& s : stations)
      EXPECT_LE(std::abs(s.station.curvature_1_m) * problem.rover->min_turn_radius_m, 1.0 + 1e-9);
  }
}

// Whatever the default set is, the grid's way and the straight line are simulated: on open ground the best
// route is no longer than either.
TEST(GridPlanner, AndTheStraightLineAreCandidatesUnasked) {
  PlanProblem problem = problem_of(kYard);
  const Plan plan = grid_plan(problem);
  ASSERT_FALSE(plan.routes.empty());
  problem.planners = {"grid"};
  problem.routes = 1;
  EXPECT_LE(plan.routes[0].cost, 1.03 * grid_plan(problem).routes.at(0).cost);
}

TEST(GridPlanner, FindsItsWayBetweenKeepOutsAndKeepsTheGoalsHeading) {
  PlanProblem problem = problem_of(kYard);
  problem.planners = {"grid"};
  problem.goal.yaw_rad = -2.0;
  problem.keep_out = {{{13.0, 8.0}, {16.0, 8.0}, {16.0, 11.0}, {13.0, 11.0}},
                      {{29.0, 9.0}, {31.0, 9.0}, {31.0, 13.0}, {29.0, 13.0}}};
  const KeepOut keep_out(problem.keep_out, *problem.rover);
  const Plan plan = grid_plan(problem);
  ASSERT_FALSE(plan.routes.empty()) << plan.fewer_because.at(0);
  for (const Route& route : plan.routes) {
    for (const sim::StationPrediction& s : route.prediction.stations)
      EXPECT_FALSE(keep_out.hits(s.station.pose));
    EXPECT_NEAR(route.prediction.stations.back().station.pose.yaw_rad, -2.0, rad_from_deg(0.2));
  }
}

}  // namespace
}  // namespace slipway::planner
