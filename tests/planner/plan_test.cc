#include <gtest/gtest.h>

#include <algorithm>

#include "core/angle.h"
#include "planner/problem/keep_out.h"
#include "planner/search/select_routes.h"
#include "tests/planner/open_ground.h"

namespace slipway::planner {
namespace {

// Everything that a client sees, bit by bit.
std::vector<double> numbers_of(const Plan& plan) {
  std::vector<double> numbers;
  for (const Route& route : plan.routes) {
    numbers.insert(numbers.end(), {route.cost, route.prediction.risk, route.prediction.duration_s});
    for (const sim::StationPrediction& s : route.prediction.stations) {
      numbers.insert(numbers.end(), {s.station.pose.x_m, s.station.pose.y_m, s.station.pose.yaw_rad,
                                     s.state.slip_ratio, s.slip_ratio_p95});
    }
  }
  return numbers;
}

std::vector<std::string> words_of(const Plan& plan) {
  std::vector<std::string> words = plan.fewer_because;
  for (const Route& route : plan.routes)
    words.insert(words.end(), route.reasons.begin(), route.reasons.end());
  return words;
}

TEST(Plan, FindsThreeRoutesThatDifferOnOpenGround) {
  const PlanProblem problem = problem_of(kOpen);
  const Plan plan = plan_of(problem);
  ASSERT_EQ(plan.routes.size(), 3U) << (plan.fewer_because.empty() ? "" : plan.fewer_because.front());
  Differences differences(problem.rover->body_width_m);
  for (const Route& route : plan.routes) {
    std::vector<Eigen::Vector2d> line;
    for (const auto& s : route.prediction.stations) line.emplace_back(s.station.pose.x_m, s.station.pose.y_m);
    differences.add(line);
    EXPECT_NEAR(route.prediction.stations.back().station.pose.x_m, problem.goal.x_m, 0.05);
    EXPECT_NEAR(route.prediction.stations.back().station.pose.y_m, problem.goal.y_m, 0.05);
  }
  for (std::size_t a = 0; a < 3; ++a)
    for (std::size_t b = 0; b < a; ++b) EXPECT_LE(differences.shared(a, b), kMaxOverlap + 0.02);
  EXPECT_TRUE(plan.fewer_because.empty());
  EXPECT_EQ(plan.routes.front().verdict(), Verdict::kGo);
  EXPECT_LE(plan.routes[0].cost, plan.routes[1].cost);
  EXPECT_LT(plan.routes[0].prediction.length_m, 32.0 * 1.03);
}

TEST(Plan, SharesAddUpToTheCost) {
  const Plan plan = plan_of(problem_of(kOpen));
  ASSERT_FALSE(plan.routes.empty());
  for (const Route& route : plan.routes) {
    double sum = 0.0;
    for (const CostShare& share : route.shares) sum += share.cost;
    EXPECT_NEAR(sum, route.cost, 1e-12);
    EXPECT_FALSE(route.reasons.empty());
  }
}

TEST(Plan, TheSameRequestGivesTheSameBytesOnOneAndTwoThreadsAndAfterAnotherPlan) {
  PlanProblem problem = problem_of(kOpen);
  problem.threads = 1;
  const Plan first = plan_of(problem);
  PlanProblem other = problem;
  other.goal.y_m += 4.0;
  const Plan unrelated = plan_of(other);
  problem.threads = 2;
  const Plan second = plan_of(problem);
  EXPECT_EQ(numbers_of(first), numbers_of(second));
  EXPECT_EQ(words_of(first), words_of(second));
  EXPECT_NE(numbers_of(first), numbers_of(unrelated));
}

TEST(Plan, GoesRoundTheSteepHill) {
  const Plan plan = plan_of(problem_of(R"(
. . . . . . . . . . . . . . . . . . . . . .
. . . . . . . . . . . . . . . . . . . . . .
. . . . . . . . . . . . . . . . . . . . . .
. . . . . . . . . 5 5 5 5 . . . . . . . . .
. . . . . . . . . 5 9 9 5 . . . . . . . . .
. . . S . . . . . 5 9 9 5 . . . . . . G . .
. . . . . . . . . 5 9 9 5 . . . . . . . . .
. . . . . . . . . 5 5 5 5 . . . . . . . . .
. . . . . . . . . . . . . . . . . . . . . .
. . . . . . . . . . . . . . . . . . . . . .
. . . . . . . . . . . . . . . . . . . . . .
)",
                                       2.0, 0.4));
  ASSERT_FALSE(plan.routes.empty());
  EXPECT_GT(plan.routes[0].prediction.length_m, 33.0);
  EXPECT_LT(plan.routes[0].prediction.max_tilt_rad.value, rad_from_deg(15.0));
}

TEST(Plan, AvoidsTheSoftPatchThoughTheWayIsLonger) {
  const Plan plan = plan_of(problem_of(R"(
. . . . . . . . . . . . . . . . . . . . . .
. . . . . . . . . . . . . . . . . . . . . .
. . . . . . . . s s s s s . . . . . . . . .
. . . . . . . . s s s s s . . . . . . . . .
. . . S . . . . s s s s s . . . . . . G . .
. . . . . . . . s s s s s . . . . . . . . .
. . . . . . . . s s s s s s . . . . . . . .
. . . . . . . . s s s s s s . . . . . . . .
. . . . . . . . . . . . . . . . . . . . . .
)"));
  ASSERT_FALSE(plan.routes.empty());
  EXPECT_GT(plan.routes[0].prediction.length_m, 32.3);
  // Of the 10 m of soft ground on the straight way at most a corner is cut.
  double soft_m = 0.0;
  const auto& stations = plan.routes[0].prediction.stations;
  for (std::size_t k = 1; k < stations.size(); ++k)
    if (stations[k].soil == std::size_t{1})
      soft_m += stations[k].station.distance_m - stations[k - 1].station.distance_m;
  EXPECT_LT(soft_m, 3.0);
}

TEST(Plan, GoesRoundMissingElevation) {
  const Plan plan = plan_of(problem_of(R"(
. . . . . . . . . . . . . . . . . . . . . .
. . . . . . . . . . . . . . . . . . . . . .
. . . . . . . . . . . . . . . . . . . . . .
. . . . . . . . . . # # . . . . . . . . . .
. . . S . . . . . . # # . . . . . . . G . .
. . . . . . . . . . # # . . . . . . . . . .
. . . . . . . . . . . . . . . . . . . . . .
. . . . . . . . . . . . . . . . . . . . . .
. . . . . . . . . . . . . . . . . . . . . .
)"));
  ASSERT_FALSE(plan.routes.empty());
  for (const Route& route : plan.routes) EXPECT_GT(route.prediction.length_m, 33.0);
}

TEST(Plan, DrivesRoundAKeepOutWithItsWholeBody) {
  PlanProblem problem = problem_of(kOpen);
  problem.keep_out = {{{20.0, 5.0}, {24.0, 5.0}, {24.0, 13.0}, {20.0, 13.0}}};
  const Plan plan = plan_of(problem);
  ASSERT_FALSE(plan.routes.empty());
  const KeepOut keep_out(problem.keep_out, *problem.rover);
  for (const Route& route : plan.routes)
    EXPECT_FALSE(ever(route, [&](const auto& s) { return keep_out.hits(s.station.pose); }));
}

TEST(Plan, StaysInAKeepInWithItsWholeBody) {
  PlanProblem problem = problem_of(kOpen);
  const Plan free = plan_of(problem);
  ASSERT_FALSE(free.routes.empty());
  // A bend from start to goal that the straight way leaves.
  const Eigen::Vector2d a(problem.start.x_m, problem.start.y_m), b(problem.goal.x_m, problem.goal.y_m);
  problem.keep_in = {{{a.x() - 3.0, 1.0},
                      {b.x() + 3.0, 1.0},
                      {b.x() + 3.0, b.y() + 3.0},
                      {b.x() - 3.0, b.y() + 3.0},
                      {b.x() - 3.0, 4.5},
                      {a.x() + 3.0, 4.5},
                      {a.x() + 3.0, a.y() + 3.0},
                      {a.x() - 3.0, a.y() + 3.0}}};
  const KeepOut keep_in({}, *problem.rover, problem.keep_in);
  EXPECT_TRUE(ever(free.routes.front(), [&](const auto& s) { return keep_in.hits(s.station.pose); }));
  const Plan plan = plan_of(problem);
  ASSERT_FALSE(plan.routes.empty()) << plan.fewer_because.front();
  for (const Route& route : plan.routes)
    EXPECT_FALSE(ever(route, [&](const auto& s) { return keep_in.hits(s.station.pose); }));
}

TEST(Plan, WithOneNarrowCorridorSaysWhyThereAreFewerRoutes) {
  const Plan plan = plan_of(problem_of(R"(
# # # # # # # # # # # # # # # # # # # # # #
# # # # # # # # # # # # # # # # # # # # # #
. . . . . . . . . . . . . . . . . . . . . .
. . . S . . . . . . . . . . . . . . . G . .
. . . . . . . . . . . . . . . . . . . . . .
# # # # # # # # # # # # # # # # # # # # # #
# # # # # # # # # # # # # # # # # # # # # #
)"));
  ASSERT_GE(plan.routes.size(), 1U);
  ASSERT_LT(plan.routes.size(), 3U);
  ASSERT_EQ(plan.fewer_because.size(), 2U) << plan.fewer_because[0];
  EXPECT_NE(plan.fewer_because[0].find("share more than 60 %"), std::string::npos) << plan.fewer_because[0];
  EXPECT_NE(plan.fewer_because[1].find("passes one gap"), std::string::npos) << plan.fewer_because[1];
}

TEST(Plan, AllRoutesPassTheOnlyGap) {
  const Plan plan = plan_of(problem_of(kOneGap));
  ASSERT_FALSE(plan.routes.empty());
  for (const Route& route : plan.routes) {
    EXPECT_TRUE(ever(route, [](const auto& s) {
      return std::abs(s.station.pose.x_m - 21.0) < 0.3 && s.station.pose.y_m > 4.0 &&
             s.station.pose.y_m < 10.0;
    }));
  }
}

TEST(Plan, RoutesThroughTwoGapsDiffer) {
  PlanProblem problem = problem_of(R"(
. . . . . . . . . . # . . . . . . . . . . .
. . . . . . . . . . . . . . . . . . . . . .
. . . . . . . . . . . . . . . . . . . . . .
. . . . . . . . . . . . . . . . . . . . . .
. . . S . . . . . . # . . . . . . . . G . .
. . . . . . . . . . . . . . . . . . . . . .
. . . . . . . . . . . . . . . . . . . . . .
. . . . . . . . . . . . . . . . . . . . . .
. . . . . . . . . . # . . . . . . . . . . .
)");
  problem.routes = 2;
  const Plan plan = plan_of(problem);
  ASSERT_EQ(plan.routes.size(), 2U);
  const auto north = [](const auto& s) {
    return std::abs(s.station.pose.x_m - 21.0) < 0.3 && s.station.pose.y_m > 9.0;
  };
  EXPECT_NE(ever(plan.routes[0], north), ever(plan.routes[1], north));
}

TEST(Plan, AWalledInGoalIsAnAnswerWithoutRoutesAndWithAReason) {
  const Plan plan = plan_of(problem_of(R"(
. . . . . . . . . . . . . . # # # # # # # #
. . . . . . . . . . . . . . # . . . . . . #
. . . S . . . . . . . . . . # . . . G . . #
. . . . . . . . . . . . . . # . . . . . . #
. . . . . . . . . . . . . . # # # # # # # #
. . . . . . . . . . . . . . . . . . . . . .
)"));
  EXPECT_TRUE(plan.routes.empty());
  ASSERT_EQ(plan.fewer_because.size(), 1U);
  EXPECT_NE(plan.fewer_because[0].find("without elevation"), std::string::npos) << plan.fewer_because[0];
}

TEST(Plan, OnUnknownGroundAFewDrawsMakeNoGo) {
  PlanProblem problem = problem_of(kOpen);
  problem.soil_map = nullptr;
  problem.risk.bars = {};
  const Plan plan = plan_of(problem);
  ASSERT_FALSE(plan.routes.empty());
  for (const Route& route : plan.routes) EXPECT_NE(route.verdict(), Verdict::kGo);
  EXPECT_NE(plan.routes[0].reasons[0].find("do not decide"), std::string::npos) << plan.routes[0].reasons[0];
}

TEST(Plan, VisitsWaypointsInOrderAndKeepsTheGoalsHeading) {
  PlanProblem problem = problem_of(kOpen);
  problem.waypoints = {{25.0, 14.0, std::nullopt}, {15.0, 5.0, std::nullopt}};
  problem.goal.yaw_rad = 1.0;
  const Plan plan = plan_of(problem);
  ASSERT_FALSE(plan.routes.empty());
  for (const Route& route : plan.routes) {
    double last = 0.0;
    for (const Waypoint& place : problem.waypoints) {
      const auto at = std::find_if(
          route.prediction.stations.begin(), route.prediction.stations.end(), [&](const auto& s) {
            return s.station.distance_m >= last &&
                   std::hypot(s.station.pose.x_m - place.x_m, s.station.pose.y_m - place.y_m) < 0.05;
          });
      ASSERT_NE(at, route.prediction.stations.end());
      last = at->station.distance_m;
    }
    EXPECT_NEAR(wrapped_rad(route.prediction.stations.back().station.pose.yaw_rad - 1.0), 0.0,
                rad_from_deg(0.2));
  }
}

}  // namespace
}  // namespace slipway::planner
