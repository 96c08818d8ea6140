#include "sim/dynamic/drive_leg.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "core/angle.h"
#include "core/random.h"

namespace slipway::sim {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr Pose2 kStart{2.0, -1.0, 0.6};

void expect_near(const Pose2& pose, const Pose2& expected, double tolerance, const std::string& said = {}) {
  EXPECT_NEAR(pose.x_m, expected.x_m, tolerance) << said;
  EXPECT_NEAR(pose.y_m, expected.y_m, tolerance) << said;
  EXPECT_NEAR(pose.yaw_rad, expected.yaw_rad, tolerance) << said;
}

// The pose that results from moving in the axes of another.
Pose2 moved(const Pose2& from, double forward_m, double left_m, double turned_rad) {
  const double c = std::cos(from.yaw_rad), s = std::sin(from.yaw_rad);
  return {from.x_m + c * forward_m - s * left_m, from.y_m + s * forward_m + c * left_m,
          from.yaw_rad + turned_rad};
}

TEST(DriveLeg, LastsItsLengthOverItsSpeedAndATurnItsAngleOverItsRate) {
  EXPECT_DOUBLE_EQ(commanded_duration_s({{.speed_m_s = -0.05}, 2.0, 0.0}), 40.0);
  EXPECT_DOUBLE_EQ(commanded_duration_s({{.turn_in_place = true, .turn_rate_rad_s = -0.02}, 0.0, 0.5}), 25.0);
}

TEST(DriveLeg, AStraightGoesAheadAndBackwardsGoesBack) {
  expect_near(commanded_pose({{.speed_m_s = 0.04}, 3.0, 0.0}, kStart, 0.5), moved(kStart, 1.5, 0.0, 0.0),
              1e-15);
  expect_near(commanded_pose({{.speed_m_s = -0.04}, 3.0, 0.0}, kStart, 1.0), moved(kStart, -3.0, 0.0, 0.0),
              1e-15);
}

TEST(DriveLeg, AQuarterOfACircleToTheLeftEndsARadiusAheadAndARadiusToTheLeft) {
  const DriveLeg left{{.curvature_1_m = 0.5}, kPi, 0.0};
  expect_near(commanded_pose(left, kStart, 1.0), moved(kStart, 2.0, 2.0, kPi / 2), 1e-14);
  const DriveLeg right{{.curvature_1_m = -0.5}, kPi, 0.0};
  expect_near(commanded_pose(right, kStart, 1.0), moved(kStart, 2.0, -2.0, -kPi / 2), 1e-14);
  // Backwards the centre stays on the left, and the heading turns to the right.
  const DriveLeg back{{.speed_m_s = -0.04, .curvature_1_m = 0.5}, kPi, 0.0};
  expect_near(commanded_pose(back, kStart, 1.0), moved(kStart, -2.0, 2.0, -kPi / 2), 1e-14);
}

TEST(DriveLeg, CrabbingKeepsTheHeadingAndGoesAskew) {
  const DriveLeg crab{{.crab_rad = 0.3}, 2.0, 0.0};
  expect_near(commanded_pose(crab, kStart, 1.0), moved(kStart, 2.0 * std::cos(0.3), 2.0 * std::sin(0.3), 0.0),
              1e-15);
}

TEST(DriveLeg, ATurnInPlaceStaysWhereItIs) {
  const DriveLeg turn{{.turn_in_place = true, .turn_rate_rad_s = -0.03}, 0.0, 0.8};
  expect_near(commanded_pose(turn, kStart, 0.25), moved(kStart, 0.0, 0.0, -0.2), 1e-15);
  const LegPlace place = place_on_leg(turn, kStart, {2.3, -1.2, 0.2}, -0.4);
  EXPECT_DOUBLE_EQ(place.share, 0.5);
  EXPECT_EQ(place.across_m, 0.0);
  EXPECT_NEAR(place.heading_rad, 0.0, 1e-15);
}

// A leg of any kind that drives somewhere.
DriveLeg any_leg(std::uint64_t trial, double longest_rad) {
  DriveLeg leg;
  const double sign = random_uniform(1, trial) < 0.5 ? -1.0 : 1.0;
  leg.command.speed_m_s = sign * (0.01 + 0.1 * random_uniform(2, trial));
  leg.command.curvature_1_m = trial % 4 == 0 ? 0.0 : 4.0 * random_uniform(3, trial) - 2.0;
  leg.command.crab_rad = trial % 3 == 0 ? 0.0 : 2.0 * random_uniform(4, trial) - 1.0;
  leg.length_m = std::min(10.0, longest_rad / std::abs(leg.command.curvature_1_m)) * random_uniform(5, trial);
  return leg;
}

TEST(DriveLeg, ThePoseMovesAsTheCommandSays) {
  for (std::uint64_t trial = 0; trial < 200; ++trial) {
    const DriveLeg leg = any_leg(trial, 6.0);
    const double step = 1e-5, time = step * commanded_duration_s(leg);
    const Pose2 here = commanded_pose(leg, kStart, 0.7);
    const Pose2 before = commanded_pose(leg, kStart, 0.7 - step),
                after = commanded_pose(leg, kStart, 0.7 + step);
    const Eigen::Vector2d direction =
        Eigen::Rotation2Dd(here.yaw_rad) * travel_direction(leg.command) * leg.command.speed_m_s;
    EXPECT_NEAR((after.x_m - before.x_m) / (2.0 * time), direction.x(), 1e-8) << trial;
    EXPECT_NEAR((after.y_m - before.y_m) / (2.0 * time), direction.y(), 1e-8) << trial;
    EXPECT_NEAR((after.yaw_rad - before.yaw_rad) / (2.0 * time),
                leg.command.speed_m_s * leg.command.curvature_1_m, 1e-8)
        << trial;
  }
}

TEST(DriveLeg, APlaceIsFoundWhereItWasMadeBeforeOnAndBehindTheLeg) {
  for (std::uint64_t trial = 0; trial < 2000; ++trial) {
    // The arcs have up to three full turns, which the heading's change distinguishes.
    const DriveLeg leg = any_leg(trial, 6.0 * kPi);
    const double share = 1.4 * random_uniform(6, trial) - 0.2;
    const double reach = std::min(0.3, 0.5 / std::abs(leg.command.curvature_1_m));
    const double across = reach * (2.0 * random_uniform(7, trial) - 1.0);
    const double askew = random_uniform(8, trial) - 0.5;
    const Pose2 there = commanded_pose(leg, kStart, share);
    const double travel = there.yaw_rad + leg.command.crab_rad + (leg.command.speed_m_s < 0.0 ? kPi : 0.0);
    const Pose2 now{there.x_m - across * std::sin(travel), there.y_m + across * std::cos(travel),
                    wrapped_rad(there.yaw_rad + askew)};
    const LegPlace place = place_on_leg(leg, kStart, now, there.yaw_rad + askew - kStart.yaw_rad);
    EXPECT_NEAR(place.share * leg.length_m, share * leg.length_m, 1e-11) << trial;
    EXPECT_NEAR(place.across_m, across, 1e-12) << trial;
    EXPECT_NEAR(place.heading_rad, askew, 1e-11) << trial;
  }
}

TEST(DriveLeg, AnArcThatIsAlmostStraightIsAlmostTheStraight) {
  const DriveLeg straight{{}, 5.0, 0.0}, arc{{.curvature_1_m = 1e-13}, 5.0, 0.0};
  expect_near(commanded_pose(arc, kStart, 0.8), commanded_pose(straight, kStart, 0.8), 1e-11);
  const Pose2 now = moved(kStart, 2.0, 0.1, 0.05);
  const LegPlace on_arc = place_on_leg(arc, kStart, now, 0.05),
                 on_straight = place_on_leg(straight, kStart, now, 0.05);
  EXPECT_NEAR(on_arc.share, on_straight.share, 1e-11);
  EXPECT_NEAR(on_arc.across_m, on_straight.across_m, 1e-11);
  EXPECT_NEAR(on_straight.share, 0.4, 1e-15);
  EXPECT_NEAR(on_straight.across_m, 0.1, 1e-15);
}

TEST(DriveLeg, ALegOfNoLengthIsDone) {
  EXPECT_EQ(place_on_leg({}, kStart, kStart, 0.0).share, 1.0);
  EXPECT_EQ(
      place_on_leg({{.turn_in_place = true, .turn_rate_rad_s = 0.1}, 0.0, 0.0}, kStart, kStart, 0.0).share,
      1.0);
}

}  // namespace
}  // namespace slipway::sim
