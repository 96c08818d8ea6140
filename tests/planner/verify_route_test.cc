#include "planner/judge/verify_route.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/angle.h"
#include "dem/synthetic_terrain.h"
#include "planner/judge/drive_legs.h"
#include "planner/judge/rank.h"
#include "planner/problem/terrain_ground.h"
#include "tests/planner/plan_fixture.h"

namespace slipway::planner {
namespace {

constexpr std::string_view kYard = R"(
. . . . . . . . . . . . . . . .
. . . . . . . . . . . . . . . .
. . S . . . . . . . . . G . . .
. . . . . . . . . . . . . . . .
. . . . . . . . . . . . . . . .
. . . . . . . . . . . . . . . .
)";

std::vector<Motion> crooked(const sim::RoverModel& rover) {
  const MotionLimits limits = motion_limits(rover);
  std::vector<Motion> motions{straight({1.0, 2.0, 0.4}, 4.0, 2.5)};
  motions.push_back(connect(motions.back().to, {7.0, 4.0, 1.0}, limits));
  motions.push_back(connect(motions.back().to, {6.5, 7.0, -2.0}, limits));
  motions.push_back(connect(motions.back().to, {3.0, 8.0, -3.0}, limits));
  return motions;
}

TEST(DriveLegs, EndWhereTheMotionsEndForwardsBackwardsAndAtAnAngle) {
  const auto rover = test_rover();
  const std::vector<Motion> motions = crooked(*rover);
  for (const Manner& manner : {Manner{}, Manner{.backwards = true}, Manner{.crab_rad = 0.5},
                               Manner{.backwards = true, .crab_rad = -0.3}}) {
    Pose2 pose = drive_start(motions, manner);
    double length = 0.0;
    for (const sim::DriveLeg& leg : drive_legs(motions, *rover, manner)) {
      pose = sim::commanded_pose(leg, pose, 1.0);
      length += leg.length_m;
    }
    EXPECT_NEAR(pose.x_m, motions.back().to.x_m, 1e-9);
    EXPECT_NEAR(pose.y_m, motions.back().to.y_m, 1e-9);
    EXPECT_NEAR(wrapped_rad(pose.yaw_rad - manner.body_yaw(motions.back().to.yaw_rad)), 0.0, 1e-9);
    double way = 0.0;
    for (const Motion& motion : motions) way += motion.length_m;
    EXPECT_NEAR(length, way, 1e-9);
  }
}

TEST(DriveLegs, WhatIsDrivenWithoutAHaltIsOneLeg) {
  const auto rover = test_rover();
  Motion first = straight({0.0, 0.0, 0.0}, 2.0, 0.0);
  first.last_turn_rad = 0.5;
  first.to.yaw_rad = 0.5;
  Motion second = straight(first.to, 2.0, 3.0);
  const Motion third = straight(second.to, 2.0, 5.0);
  const auto legs = drive_legs({first, second, third}, *rover);
  ASSERT_EQ(legs.size(), 3U);
  EXPECT_TRUE(legs[1].command.turn_in_place);
  EXPECT_NEAR(legs[1].turn_rad, std::numbers::pi / 2.0, 1e-12);
  EXPECT_NEAR(legs[2].length_m, 5.0, 1e-12);
}

TEST(DriveLegs, ATurnThatIsTakenBackIsNone) {
  Motion there, back;
  there.last_turn_rad = 0.5;
  back.first_turn_rad = -0.5;
  EXPECT_TRUE(drive_legs({there, back}, *test_rover()).empty());
}

struct Driven {
  sim::DrivePrediction balance;
  DynamicVerification dynamic;
};

Driven driven(const PlanProblem& problem, const std::vector<Waypoint>& corners, const Manner& manner = {}) {
  NoProgress progress;
  auto balance = predict_path(problem, corners, progress, manner);
  EXPECT_TRUE(balance) << balance.error().detail;
  auto dynamic = verify_path(problem, corners, balance.value(), progress, manner);
  EXPECT_TRUE(dynamic) << dynamic.error().detail;
  return {std::move(*balance), std::move(*dynamic)};
}

const std::vector<Waypoint> kCorner{
    {5.0, 8.0, std::nullopt}, {9.0, 8.0, std::nullopt}, {9.0, 5.0, std::nullopt}};

TEST(VerifyRoute, OnLevelGroundBothSimulationsAgreeAndTheDriveArrives) {
  const PlanProblem problem = problem_of(kYard);
  for (const Manner& manner : {Manner{}, Manner{.backwards = true}}) {
    const auto [balance, dynamic] = driven(problem, kCorner, manner);
    ASSERT_EQ(dynamic.end, sim::DriveEnd::kFinished) << dynamic.reason;
    EXPECT_TRUE(dynamic.reason.empty());
    EXPECT_NEAR(dynamic.pose.x_m, 9.0, 0.05);
    EXPECT_NEAR(dynamic.pose.y_m, 5.0, 0.05);
    EXPECT_NEAR(dynamic.distance_m, balance.length_m, 0.1);
    EXPECT_NEAR(dynamic.commanded_m, 7.0, 1e-9);
    EXPECT_GT(dynamic.compared_m, 5.0);
    EXPECT_LT(dynamic.slip_ratio.mean_abs, 0.02);
    EXPECT_LT(dynamic.sinkage_m.mean_abs, 0.003);
    EXPECT_LE(std::abs(dynamic.slip_ratio.mean), dynamic.slip_ratio.mean_abs);
    EXPECT_GE(dynamic.slip_ratio.largest.value, dynamic.slip_ratio.mean_abs);
    EXPECT_GT(dynamic.duration_s, balance.duration_s) << "it also starts, stops and steers";
    EXPECT_FALSE(dynamic.refutes());
    EXPECT_GT(dynamic.work.steps, 0);
  }
}

TEST(VerifyRoute, SamplesAreBoundedInOrderAndEndWhereTheDriveEnds) {
  const auto dynamic =
      driven(problem_of(kYard), {{3.0, 8.0, std::nullopt}, {28.0, 8.0, std::nullopt}}).dynamic;
  ASSERT_EQ(dynamic.end, sim::DriveEnd::kFinished) << dynamic.reason;
  EXPECT_LE(dynamic.samples.size(), kMaxVerificationSamples);
  EXPECT_GE(dynamic.samples.size(), kMaxVerificationSamples / 2);
  EXPECT_EQ(dynamic.samples.front().time_s, 0.0);
  EXPECT_NEAR(dynamic.samples.back().time_s, dynamic.duration_s, 1e-9);
  for (std::size_t k = 1; k < dynamic.samples.size(); ++k)
    EXPECT_GT(dynamic.samples[k].time_s, dynamic.samples[k - 1].time_s);
  EXPECT_EQ(dynamic.wheel_names.size(), dynamic.samples.front().wheels.size());
}

TEST(VerifyRoute, ALimitThatIsBrokenIsNamedInTheBalancesWords) {
  PlanProblem problem = problem_of(kYard);
  problem.limits.max_sinkage_m = 0.001;
  const auto [balance, dynamic] = driven(problem, kCorner);
  ASSERT_EQ(dynamic.broken_limits.size(), 1U);
  ASSERT_EQ(balance.broken_limits.size(), 1U);
  const std::string words = describe(dynamic.broken_limits[0]);
  EXPECT_TRUE(words.starts_with("sinkage 0.0")) << words;
  EXPECT_TRUE(words.ends_with(" m, limit 0.001 m")) << words;
  EXPECT_TRUE(dynamic.refutes());
}

TEST(VerifyRoute, OnASlopeThatTheSoilDoesNotHoldTheRoverGetsNowhere) {
  PlanProblem problem = problem_of(kYard);
  problem.terrain = dem::make_ramp({.size_m = 60.0, .cell_m = 1.0}, rad_from_deg(24.0), 0.0);
  problem.soil_map = nullptr;
  // The balance has nothing to say of what lies behind the place where it gives up.
  const auto [balance, dynamic] = driven(problem, {{-8.0, 0.0, std::nullopt}, {8.0, 0.0, std::nullopt}});
  ASSERT_TRUE(balance.immobilised);
  ASSERT_TRUE(dynamic.end);
  EXPECT_NE(*dynamic.end, sim::DriveEnd::kFinished);
  EXPECT_FALSE(dynamic.reason.empty());
  EXPECT_LT(dynamic.distance_m, 16.0);
  EXPECT_TRUE(dynamic.refutes());
  EXPECT_EQ(dynamic.compared_m, 0.0);
}

TEST(VerifyRoute, APathOfOnePlaceIsDrivenAtOnce) {
  const auto dynamic = driven(problem_of(kYard), {{5.0, 8.0, std::nullopt}}).dynamic;
  EXPECT_EQ(dynamic.end, sim::DriveEnd::kFinished);
  EXPECT_TRUE(dynamic.samples.empty());
}

TEST(VerifyRoute, SaysHowFarFromTheRouteTheDriveWas) {
  const auto dynamic = driven(problem_of(kYard), kCorner).dynamic;
  ASSERT_EQ(dynamic.end, sim::DriveEnd::kFinished) << dynamic.reason;
  EXPECT_FALSE(dynamic.left_the_route);
  const OffRoute& off = dynamic.max_distance_from_route;
  EXPECT_GT(off.distance_m, 0.0);
  EXPECT_LT(off.distance_m, 0.15);
  EXPECT_LE(off.at_m, dynamic.commanded_m + 0.1);
  EXPECT_GE(off.x_m, 4.5);
  EXPECT_LE(off.x_m, 9.5);
}

// The commands lead the rover on along y = 8, the route goes on along y = 12.
TEST(VerifyRoute, ADriveThatLeavesItsRouteNeitherConfirmsNorRefutesIt) {
  PlanProblem problem = problem_of(kYard);
  NoProgress progress;
  const std::vector<Motion> motions{straight({5.0, 8.0, 0.0}, 9.0, 8.0),
                                    straight({9.0, 10.5, 0.0}, 16.0, 10.5)};
  const auto dynamic = verify_route(problem, motions, {}, {}, progress);
  ASSERT_TRUE(dynamic);
  EXPECT_TRUE(dynamic->left_the_route);
  EXPECT_FALSE(dynamic->end);
  EXPECT_FALSE(dynamic->refutes());
  EXPECT_EQ(end_in_words(*dynamic), "left_the_route");
  const double most = max_off_route_m(*problem.rover);
  EXPECT_GT(dynamic->max_distance_from_route.distance_m, most);
  EXPECT_LT(dynamic->max_distance_from_route.distance_m, most + 0.1);
  EXPECT_NEAR(dynamic->max_distance_from_route.y_m, 8.0, 0.2);
  EXPECT_NEAR(dynamic->pose.x_m, dynamic->max_distance_from_route.x_m, 1e-9);
  Route route;
  route.prediction = predict_path(problem, kCorner, progress).value();
  route.prediction.risk = 0.0;
  route.dynamic = *dynamic;
  judge(problem, route);
  EXPECT_EQ(route.verdict(), Verdict::kUnknown);
  std::vector<Route> routes{route};
  explain(routes);
  EXPECT_TRUE(routes[0].reasons[0].starts_with(
      "UNKNOWN: neither confirmed nor refuted by the drive in motion: the drive is 1.7"))
      << routes[0].reasons[0];
}

TEST(Explain, HasWordsForARouteWithoutStations) {
  std::vector<Route> routes(1);
  explain(routes);
  EXPECT_EQ(routes[0].reasons.back(), "largest slip 0.00");
}

// A cross slope on which the rover slides down in every turn and on every metre, with a turn every few
// metres.
TEST(VerifyRoute, KeepsToACrookedRouteAcrossASlope) {
  PlanProblem problem = problem_of(kYard);
  problem.terrain =
      dem::make_ramp({.size_m = 80.0, .cell_m = 1.0}, rad_from_deg(12.0), 0.5 * std::numbers::pi);
  problem.soil_map = nullptr;
  problem.beliefs.unknown = firm_soil("unknown");
  std::vector<Waypoint> corners{{-14.0, 0.0, std::nullopt}};
  for (int k = 1; k <= 10; ++k) corners.push_back({-14.0 + 2.0 * k, k % 2 == 0 ? 0.0 : 2.0, std::nullopt});
  const auto dynamic = driven(problem, corners).dynamic;
  ASSERT_EQ(dynamic.end, sim::DriveEnd::kFinished) << dynamic.reason;
  EXPECT_LT(dynamic.max_distance_from_route.distance_m, 1.0);
  EXPECT_NEAR(std::hypot(dynamic.pose.x_m - corners.back().x_m, dynamic.pose.y_m - corners.back().y_m), 0.0,
              0.7);
}

class CancelledAfter final : public Progress {
 public:
  explicit CancelledAfter(int questions) : left_(questions) {}
  void report(std::string_view, double) override {}
  bool cancelled() const override { return --left_ < 0; }

 private:
  mutable int left_;
};

TEST(VerifyRoute, StopsWhenItIsCancelledOnTheWay) {
  const PlanProblem problem = problem_of(kYard);
  NoProgress patient;
  const auto balance = predict_path(problem, kCorner, patient);
  CancelledAfter progress(100);
  const auto dynamic = verify_path(problem, kCorner, balance.value(), progress);
  ASSERT_FALSE(dynamic);
  EXPECT_EQ(dynamic.error().code, ErrorCode::kCancelled);
}

Route safe_route(const PlanProblem& problem) {
  Route route;
  NoProgress progress;
  route.prediction = predict_path(problem, kCorner, progress).value();
  route.prediction.risk = 0.0;
  judge(problem, route);
  EXPECT_EQ(route.verdict(), Verdict::kGo);
  return route;
}

TEST(Verdict, WhatTheDynamicSimulationRefutesIsNoGoAndSaysSo) {
  const PlanProblem problem = problem_of(kYard);
  std::vector<Route> routes{safe_route(problem), safe_route(problem), safe_route(problem),
                            safe_route(problem)};
  for (Route& route : routes) route.dynamic.emplace().end = sim::DriveEnd::kFinished;
  routes[1].dynamic->end = std::nullopt;
  routes[1].dynamic->reason = "the integrator gives up";
  routes[2].dynamic->end = sim::DriveEnd::kImmobilised;
  routes[2].dynamic->reason = "stuck";
  routes[2].dynamic->distance_m = 2.0;
  routes[3].dynamic->broken_limits = {{sim::Rule::kSlipCheck, 0.5, 0.4, 3.0, -1}};
  for (Route& route : routes) judge(problem, route);
  EXPECT_EQ(routes[0].verdict(), Verdict::kGo);
  EXPECT_EQ(routes[1].verdict(), Verdict::kUnknown);
  EXPECT_EQ(routes[2].verdict(), Verdict::kNoGo);
  EXPECT_EQ(routes[3].verdict(), Verdict::kNoGo);
  EXPECT_TRUE(ranks_before(routes[0], routes[2]));
  explain(routes);
  EXPECT_EQ(routes[1].reasons[0], "UNKNOWN: no answer from the drive in motion: the integrator gives up");
  EXPECT_EQ(routes[2].reasons[0], "NO-GO: driven in motion: immobilised at 2.0 m, stuck");
  EXPECT_EQ(routes[3].reasons[0], "NO-GO: driven in motion: slip 0.5 at 3.0 m, limit 0.4");
}

TEST(PlanVerified, AsManyOfTheBestRoutesAsAskedForAreDrivenInTheDynamicSimulation) {
  PlanProblem problem = problem_of(kYard);
  problem.routes = 2;
  problem.verify = 1;
  NoProgress progress;
  const auto plan = make_plan(problem, progress);
  ASSERT_TRUE(plan) << plan.error().detail;
  ASSERT_EQ(plan->routes.size(), 2U);
  ASSERT_TRUE(plan->routes[0].dynamic);
  EXPECT_FALSE(plan->routes[1].dynamic);
  const DynamicVerification& dynamic = *plan->routes[0].dynamic;
  ASSERT_EQ(dynamic.end, sim::DriveEnd::kFinished) << dynamic.reason;
  EXPECT_NEAR(dynamic.pose.x_m, problem.goal.x_m, 0.1);
  EXPECT_NEAR(dynamic.pose.y_m, problem.goal.y_m, 0.1);
  EXPECT_NEAR(dynamic.commanded_m, plan->routes[0].prediction.length_m, 1e-6);
}

// A limit between what the balance and the drive in motion draw: each route that is verified is refuted.
TEST(PlanVerified, AfterARefutationTheNewBestIsVerifiedTooUntilOneIsOrNoneIsLeft) {
  PlanProblem problem = problem_of(kYard);
  problem.routes = 2;
  problem.verify = 1;
  NoProgress progress;
  const auto within = make_plan(problem, progress);
  ASSERT_TRUE(within) << within.error().detail;
  ASSERT_EQ(within->routes.size(), 2U);
  ASSERT_TRUE(within->routes[0].dynamic);
  EXPECT_FALSE(within->routes[1].dynamic);
  const double balance = std::max(within->routes[0].prediction.max_current_a.value,
                                  within->routes[1].prediction.max_current_a.value);
  const double in_motion = within->routes[0].dynamic->extremes.max_current_a.value;
  ASSERT_GT(in_motion, 1.02 * balance);
  problem.limits.max_current_a = 0.5 * (balance + in_motion);
  const auto plan = make_plan(problem, progress);
  ASSERT_TRUE(plan) << plan.error().detail;
  ASSERT_EQ(plan->routes.size(), 2U);
  EXPECT_TRUE(plan->routes[0].dynamic) << "the best route is verified or refuted";
  ASSERT_TRUE(plan->routes[1].dynamic) << "the one that was best at first";
  EXPECT_TRUE(plan->routes[1].dynamic->refutes());
}

TEST(PlanVerified, MoreThanThreeAreRefused) {
  PlanProblem problem = problem_of(kYard);
  problem.verify = 4;
  NoProgress progress;
  const auto plan = make_plan(problem, progress);
  ASSERT_FALSE(plan);
  EXPECT_EQ(plan.error().faults.at(0), (Fault{"/verify", "verify = 4, must be in [0, 3]"}));
}

}  // namespace
}  // namespace slipway::planner
