// Routes as commands: what is rounded does not add up, and what is commanded is what is predicted.
#include "planner/judge/route_commands.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "core/angle.h"
#include "core/random.h"
#include "planner/judge/deciding_draws.h"
#include "tests/planner/gale_fixture.h"

namespace slipway::planner {
namespace {

Pose2 end_of(const DriveSteps& steps) {
  return command_motions(steps.start, steps.steps).back().to;
}

bool is_whole(double value) {
  return std::abs(value - std::round(value)) < 1e-6;
}

void expect_rounded(const DriveSteps& steps) {
  for (const DriveStep& step : steps.steps) {
    EXPECT_TRUE(is_whole(100.0 * step.drive_m)) << step.drive_m;
    EXPECT_TRUE(is_whole(100.0 * step.radius_m)) << step.radius_m;
    EXPECT_TRUE(is_whole(1000.0 * deg_from_rad(step.turn_rad))) << deg_from_rad(step.turn_rad);
    EXPECT_TRUE((step.drive_m > 0.0) != (step.turn_rad != 0.0));
  }
}

// Straights, turns and arcs that join without a turn, at random.
std::vector<Motion> wandering(std::uint64_t key, const Pose2& from) {
  std::vector<Motion> motions;
  Pose2 at = from;
  for (std::uint64_t k = 0; k < 12; ++k) {
    const auto draw = [&](std::uint64_t n) { return random_uniform(random_key(key, k), n); };
    Motion motion{.from = at, .to = at};
    if (k % 3 == 0) motion.first_turn_rad = 2.0 * (draw(0) - 0.5);
    motion.length_m = 0.1 + 20.0 * draw(1);
    if (k % 2 == 1) motion.curvature_1_m = (draw(2) < 0.5 ? -1.0 : 1.0) / (3.0 + 40.0 * draw(3));
    if (motion.curvature_1_m != 0.0)
      motion.length_m = std::min(motion.length_m, 1.2 / std::abs(motion.curvature_1_m));
    motion.to = motion.at(motion.length_m);
    at = motion.to;
    motions.push_back(motion);
  }
  return motions;
}

TEST(RouteCommands, EndWithin5CmAnd02DegOfTheGoalWhateverIsRounded) {
  PlanProblem problem = problem_of("S . .\n. . .\n. . G\n");
  for (std::uint64_t key = 0; key < 60; ++key) {
    const auto motions = wandering(key, {10.0, 20.0, 0.3});
    problem.start = {10.0, 20.0, key % 2 == 0 ? std::nullopt : std::optional(0.3)};
    const Pose2 end = motions.back().to;
    problem.goal = {end.x_m, end.y_m, key % 3 == 0 ? std::optional(end.yaw_rad) : std::nullopt};
    const DriveSteps steps = route_commands(problem, motions);
    expect_rounded(steps);
    EXPECT_LT(std::hypot(end_of(steps).x_m - end.x_m, end_of(steps).y_m - end.y_m), 0.05) << key;
    if (problem.goal.yaw_rad) {
      EXPECT_LT(std::abs(wrapped_rad(end_of(steps).yaw_rad - end.yaw_rad)), rad_from_deg(0.2)) << key;
    }
    if (problem.start.yaw_rad) {
      EXPECT_NEAR(steps.start.yaw_rad, 0.3, 1e-9);
    }
  }
}

TEST(RouteCommands, LeaveShortDrivesAndSmallTurnsToTheirNeighbours) {
  PlanProblem problem = problem_of("S . .\n. . .\n. . G\n");
  problem.start = {0.0, 0.0, 0.0};
  problem.goal = {30.0, 0.05, std::nullopt};
  std::vector<Motion> motions;
  Pose2 at{0.0, 0.0, 0.0};
  for (const auto& [x, y] : {std::pair{10.0, 0.0}, {10.1, 0.05}, {20.0, 0.04}, {30.0, 0.05}}) {
    motions.push_back(straight(at, x, y));
    at = motions.back().to;
  }
  const DriveSteps steps = route_commands(problem, motions);
  double driven = 0.0;
  for (const DriveStep& step : steps.steps) driven += step.drive_m;
  EXPECT_LE(steps.steps.size(), 3U);
  EXPECT_NEAR(driven, 30.0, 0.02);
  EXPECT_NEAR(end_of(steps).y_m, 0.05, 0.05);
}

// The places of defects that operators found, and others about them.
constexpr std::array<std::array<double, 4>, 6> kPairs{{
    {8142640.0, -276640.0, 8142600.0, -276645.0},
    {8142579.733, -276648.736, 8142566.402, -276711.667},
    {8142600.0, -276600.0, 8142560.0, -276640.0},
    {8142640.0, -276640.0, 8142660.0, -276600.0},
    {8142560.0, -276560.0, 8142600.0, -276580.0},
    {8142520.0, -276600.0, 8142560.0, -276570.0},
}};

TEST(GalePlan, ACheckOfARoutesCommandsGivesTheSameFigures) {
  PlanProblem problem = gale();
  problem.routes = 2;
  problem.risk.draws = kFirstDraws;
  problem.risk.max_draws = 64;
  problem.risk.bars = {};
  for (const auto& [from_x, from_y, to_x, to_y] : kPairs) {
    problem.start = {from_x, from_y, std::nullopt};
    problem.goal = {to_x, to_y, std::nullopt};
    NoProgress progress;
    const Result<Plan> plan = make_plan(problem, progress);
    ASSERT_TRUE(plan.has_value());
    ASSERT_FALSE(plan->routes.empty()) << from_x << ", " << from_y;
    for (const Route& route : plan->routes) {
      const auto motions = command_motions(route.commands.start, route.commands.steps);
      const auto check = predict_motions(problem, motions, progress);
      ASSERT_TRUE(check.has_value());
      EXPECT_EQ(check->draws, route.prediction.draws);
      EXPECT_EQ(check->outcomes.expected_stops_high, route.prediction.outcomes.expected_stops_high);
      EXPECT_EQ(check->outcomes.embedding.high, route.prediction.outcomes.embedding.high);
      EXPECT_EQ(check->duration_s_p95, route.prediction.duration_s_p95);
      EXPECT_EQ(check->energy_j, route.prediction.energy_j);
      EXPECT_EQ(check->stations.size(), route.prediction.stations.size());
      EXPECT_LT(std::hypot(motions.back().to.x_m - to_x, motions.back().to.y_m - to_y), 0.05);
    }
    // What is first is the cheapest.
    for (const Route& route : plan->routes) EXPECT_LE(plan->routes.front().cost, route.cost);
  }
}

}  // namespace
}  // namespace slipway::planner
