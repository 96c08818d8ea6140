#include <gtest/gtest.h>

#include "core/angle.h"
#include "planner/make_plan.h"
#include "tests/planner/gale_fixture.h"

namespace slipway::planner {
namespace {

int turns_in_place(const Route& route) {
  int turns = 0;
  const auto& stations = route.prediction.stations;
  for (std::size_t i = 1; i < stations.size(); ++i)
    turns += stations[i].station.turning_in_place && !stations[i - 1].station.turning_in_place ? 1 : 0;
  return turns;
}

TEST(GalePlan, ClimbsTheScarpBetweenTwoOfCuriositysStopsWithinTheLimits) {
  PlanProblem problem = gale();
  problem.start = {8142579.733, -276648.736, std::nullopt};
  problem.goal = {8142566.402, -276711.667, std::nullopt};
  NoProgress progress;
  const Result<Plan> plan = make_plan(problem, progress);
  ASSERT_TRUE(plan.has_value());
  ASSERT_EQ(plan->routes.size(), 3U) << ::testing::PrintToString(plan->fewer_because);
  // The straight line of 64 m crosses slopes of over 25 deg.
  const Route& best = plan->routes.front();
  EXPECT_NE(best.verdict(), Verdict::kNoGo);
  EXPECT_LT(best.prediction.length_m, 90.0);
  EXPECT_LE(turns_in_place(best), 4);
}

TEST(GalePlan, OfAQuarterKilometreHasThreeDifferentSmoothRoutes) {
  PlanProblem problem = gale();
  problem.start = {8142579.733, -276648.736, std::nullopt};
  problem.goal = {8142440.0, -276490.0, std::nullopt};
  NoProgress progress;
  const Result<Plan> plan = make_plan(problem, progress);
  ASSERT_TRUE(plan.has_value());
  ASSERT_EQ(plan->routes.size(), 3U);
  for (const Route& route : plan->routes) {
    EXPECT_NE(route.verdict(), Verdict::kNoGo);
    EXPECT_LE(turns_in_place(route), 6);
    EXPECT_LT(route.prediction.max_tilt_rad.value, rad_from_deg(25.0));
  }
}

}  // namespace
}  // namespace slipway::planner
