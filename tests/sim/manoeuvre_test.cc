// Crab motion, skid steering, driving backwards.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/angle.h"
#include "sim/prediction/drive_risk.h"
#include "sim/quasi_static/quasi_static.h"
#include "tests/sim/reference_models.h"

namespace slipway::sim {
namespace {

constexpr double kMars = 3.71;

StationState drive(const RoverModel& rover, const DriveCommand& command, const Attitude& attitude = {}) {
  QuasiStaticSolver solver(rover, kMars);
  return solver.solve(stance_on_plane(rover, attitude), sandy_loam(), command);
}

// The rover in axes turned by a quarter, so that its left side is ahead.
RoverModel turned_right(RoverModel rover) {
  const auto turn = [](const Eigen::Vector3d& p) { return Eigen::Vector3d(p.y(), -p.x(), p.z()); };
  rover.com_m = turn(rover.com_m);
  for (WheelModel& wheel : rover.wheels) wheel.position_m = turn(wheel.position_m);
  return rover;
}

TEST(WheelCommands, CrabMotionTurnsEverySteeredWheelTheSameWay) {
  const double crab = rad_from_deg(30.0);
  for (const WheelCommand& wheel :
       wheel_commands(all_steered(six_wheeler()), {.speed_m_s = 0.04, .crab_rad = crab})) {
    EXPECT_NEAR(wheel.steer_rad, crab, 1e-15);
    EXPECT_NEAR(wheel.rate_rad_s, 0.04 / 0.125, 1e-12);
  }
}

TEST(WheelCommands, AWheelWithoutSteeringIsCommandedTheForwardPart) {
  const auto commanded =
      wheel_commands(four_wheeler(SuspensionType::kRigid), {.speed_m_s = 0.04, .curvature_1_m = 0.5});
  EXPECT_NEAR(commanded[0].rate_rad_s, 0.04 * (1.0 - 0.5 * 0.5) / 0.125, 1e-12);
  EXPECT_NEAR(commanded[2].rate_rad_s, 0.04 * (1.0 + 0.5 * 0.5) / 0.125, 1e-12);
  for (const WheelCommand& wheel : commanded) EXPECT_EQ(wheel.steer_rad, 0.0);
}

TEST(WheelCommands, TheRoverComputesWithItsAssumedRadiusAndRollsOnTheTrueOne) {
  RoverModel rover = six_wheeler();
  for (WheelModel& wheel : rover.wheels) {
    wheel.software_radius_m = wheel.radius_m;
    wheel.radius_m = 0.9 * *wheel.software_radius_m;  // worn
  }
  EXPECT_NEAR(wheel_commands(rover, {.speed_m_s = 0.04})[0].rate_rad_s, 0.04 / 0.125, 1e-15);
  const StationState state = drive(rover, {.speed_m_s = 0.04});
  EXPECT_GT(state.slip_ratio, 0.1) << "smaller wheels fall short of the way that their turns are taken for";
  EXPECT_NEAR(state.along_m_s, 0.04 * 0.9 * (1.0 - state.wheels[1].slip_ratio), 1e-4);
}

TEST(CrabMotion, SquareToTheSideIsStraightDrivingOfTheRoverTurned) {
  const RoverModel rover = all_steered(four_wheeler(SuspensionType::kRigid));
  const StationState crab = drive(rover, {.speed_m_s = 0.04, .crab_rad = std::numbers::pi / 2});
  const StationState straight = drive(turned_right(rover), {.speed_m_s = 0.04});
  ASSERT_TRUE(crab.moving());
  EXPECT_NEAR(crab.along_m_s, straight.along_m_s, 1e-9);
  EXPECT_NEAR(crab.leftward_m_s, straight.forward_m_s, 1e-9);
  EXPECT_NEAR(crab.slip_ratio, straight.slip_ratio, 1e-7);
  EXPECT_NEAR(crab.side_slip_rad, straight.side_slip_rad, 1e-7);
  for (int k = 0; k < 4; ++k) {
    EXPECT_NEAR(crab.wheels[k].load_n, straight.wheels[k].load_n, 1e-4);
    EXPECT_NEAR(crab.wheels[k].current_a, straight.wheels[k].current_a, 1e-6);
  }
}

TEST(CrabMotion, UpASlopeSidewaysSlipsAsUpItStraight) {
  const RoverModel rover = all_steered(four_wheeler(SuspensionType::kRigid));
  const double climb = rad_from_deg(10.0);
  // Left side up is positive roll: crabbing left climbs.
  const StationState crab = drive(rover, {.crab_rad = std::numbers::pi / 2}, {.roll_rad = climb});
  const StationState straight = drive(turned_right(rover), {}, {.pitch_rad = -climb});
  ASSERT_TRUE(crab.moving());
  EXPECT_GT(crab.slip_ratio, 0.05);
  EXPECT_NEAR(crab.slip_ratio, straight.slip_ratio, 1e-7);
}

TEST(CrabMotion, TimeIsComputedAlongTheDirectionOfTravel) {
  const RoverModel rover = all_steered(six_wheeler());
  PreparedStation station;
  station.stance = stance_on_plane(rover, {});
  station.command = {.speed_m_s = 0.04, .crab_rad = rad_from_deg(60.0)};
  station.drive_m = 1.0;
  const StationState state = drive(rover, station.command);
  ASSERT_TRUE(state.moving());
  EXPECT_NEAR(effort_of(station, state).duration_s, 1.0 / state.along_m_s, 1e-9);
  EXPECT_GT(state.along_m_s, 0.03);
}

TEST(CrabMotion, WithoutSteeringThereIsNoWayToTheSide) {
  const StationState state = drive(four_wheeler(SuspensionType::kRigid), {.crab_rad = std::numbers::pi / 2});
  EXPECT_FALSE(state.moving());
}

TEST(SkidSteering, TurningInPlaceScrubsSoItYawsLessAndDrawsMoreThanSteeredWheels) {
  const DriveCommand turn{.turn_in_place = true, .turn_rate_rad_s = 0.03};
  const RoverModel skidding = four_wheeler(SuspensionType::kAveraging);
  const StationState skid = drive(skidding, turn);
  const StationState steered = drive(all_steered(skidding), turn);
  ASSERT_TRUE(skid.moving()) << describe(skid.outcome);
  ASSERT_TRUE(steered.moving());
  EXPECT_GT(skid.yaw_rate_rad_s, 0.0);
  EXPECT_LT(skid.yaw_rate_rad_s, 0.9 * 0.03);
  EXPECT_GT(skid.slip_ratio, steered.slip_ratio + 0.05);
  EXPECT_GT(largest_current_a(skid), 1.2 * largest_current_a(steered));
}

TEST(SkidSteering, OnAnArcItTurnsAsCommandedButWider) {
  const StationState state =
      drive(four_wheeler(SuspensionType::kAveraging), {.speed_m_s = 0.04, .curvature_1_m = 0.5});
  ASSERT_TRUE(state.moving());
  EXPECT_GT(state.yaw_rate_rad_s, 0.0);
  EXPECT_LT(state.yaw_rate_rad_s / state.along_m_s, 0.45);
}

TEST(SkidSteering, BackwardsIsForwardsOfTheRoverMirrored) {
  const RoverModel rover = four_wheeler(SuspensionType::kRigid);  // the same from front and rear
  const StationState forwards =
      drive(rover, {.speed_m_s = 0.04, .curvature_1_m = 0.4}, {.pitch_rad = rad_from_deg(-6.0)});
  const StationState backwards =
      drive(rover, {.speed_m_s = -0.04, .curvature_1_m = 0.4}, {.pitch_rad = rad_from_deg(6.0)});
  ASSERT_TRUE(forwards.moving());
  EXPECT_NEAR(backwards.along_m_s, -forwards.along_m_s, 1e-9);
  EXPECT_NEAR(backwards.yaw_rate_rad_s, -forwards.yaw_rate_rad_s, 1e-9);
  EXPECT_NEAR(backwards.wheels[0].load_n, forwards.wheels[1].load_n, 1e-4);
}

}  // namespace
}  // namespace slipway::sim
