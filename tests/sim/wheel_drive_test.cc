// Wheels whose motor does not follow its command.
#include <gtest/gtest.h>

#include <cmath>

#include "core/angle.h"
#include "sim/quasi_static/quasi_static.h"
#include "sim/wheel/free_wheel.h"
#include "tests/sim/reference_models.h"

namespace slipway::sim {
namespace {

constexpr double kMars = 3.71;
constexpr WheelGeometry kWheel{0.125, 0.16};

StationState level(const RoverModel& rover, const DriveCommand& command = {}) {
  QuasiStaticSolver solver(rover, kMars);
  return solver.solve(stance_on_plane(rover, {}), sandy_loam(), command);
}

TEST(LockedWheel, YawsTheRoverTowardsItsSide) {
  RoverModel rover = six_wheeler();
  rover.wheels[0].drive = WheelDrive::kLocked;
  const StationState left = level(rover);
  ASSERT_TRUE(left.moving()) << describe(left.outcome);
  EXPECT_GT(left.yaw_rate_rad_s, 1e-4) << "to the left";
  EXPECT_EQ(left.wheels[0].slip_ratio, -1.0);
  EXPECT_EQ(left.wheels[0].rate_rad_s, 0.0);
  EXPECT_EQ(left.wheels[0].current_a, 0.0);
  EXPECT_LT(left.wheels[0].drawbar_pull_n, 0.0);
  EXPECT_GT(left.slip_ratio, level(six_wheeler()).slip_ratio) << "the others drag it along";

  rover = six_wheeler();
  rover.wheels[3].drive = WheelDrive::kLocked;
  EXPECT_NEAR(level(rover).yaw_rate_rad_s, -left.yaw_rate_rad_s, 1e-9);
}

TEST(LockedWheel, BackwardsItHoldsBackToo) {
  RoverModel rover = four_wheeler(SuspensionType::kRigid);
  rover.wheels[0].drive = WheelDrive::kLocked;
  RoverModel mirrored = four_wheeler(SuspensionType::kRigid);
  mirrored.wheels[1].drive = WheelDrive::kLocked;
  const StationState backwards = level(rover, {.speed_m_s = -0.04});
  const StationState forwards = level(mirrored, {.speed_m_s = 0.04});
  ASSERT_TRUE(forwards.moving());
  EXPECT_NEAR(backwards.along_m_s, -forwards.along_m_s, 1e-8);
  EXPECT_GT(backwards.wheels[0].drawbar_pull_n, 0.0);
}

// u = v / (r w) is 1000 in the balance for a wheel that stands; ten times more or less is the same wheel.
TEST(LockedWheel, IsTheLimitOfASlowerAndSlowerOne) {
  const WheelForces at = wheel_forces(kWheel, sandy_loam(), 0.35, {.forward = 1e3});
  for (const double u : {1e2, 1e4, 1e6}) {
    const WheelForces f = wheel_forces(kWheel, sandy_loam(), 0.35, {.forward = u});
    const double size = at.vertical_n;
    EXPECT_NEAR(f.drawbar_pull_n, at.drawbar_pull_n, 0.01 * size) << u;
    EXPECT_NEAR(f.vertical_n, at.vertical_n, 0.01 * size) << u;
    EXPECT_NEAR(f.torque_nm, at.torque_nm, 0.01 * size * kWheel.radius_m) << u;
  }
}

TEST(LockedWheel, AllLockedTheRoverStaysWhereItIs) {
  RoverModel rover = six_wheeler();
  for (WheelModel& wheel : rover.wheels) wheel.drive = WheelDrive::kLocked;
  EXPECT_EQ(level(rover).outcome, Outcome::kNoTraction);
}

TEST(FreeWheel, HasNoTorqueAndSkidsByAFewPercent) {
  RoverModel rover = six_wheeler();
  rover.wheels[1].drive = WheelDrive::kFree;
  const StationState state = level(rover);
  ASSERT_TRUE(state.moving()) << describe(state.outcome);
  const WheelState& wheel = state.wheels[1];
  EXPECT_NEAR(wheel.torque_nm, 0.0, 1e-9);
  EXPECT_LT(wheel.slip_ratio, 0.0);
  EXPECT_GT(wheel.slip_ratio, -0.2);
  EXPECT_GT(wheel.rate_rad_s, 0.0);
  EXPECT_EQ(wheel.current_a, 0.0);
  EXPECT_LT(wheel.drawbar_pull_n, 0.0) << "it has to be pushed through the soil";
}

TEST(FreeWheel, ItsDragIsTheSoilsTorqueUntilItStands) {
  for (const double drag : {0.5, 2.0, 4.0}) {
    const FreeRolling rolling = roll_freely(kWheel, sandy_loam(), 0.35, {.forward = 0.9}, drag, 1e-3);
    EXPECT_NEAR(rolling.forces.torque_nm, -drag, 1e-10);
    EXPECT_LT(rolling.rim_ratio, 0.9);
  }
  const FreeRolling held = roll_freely(kWheel, sandy_loam(), 0.35, {.forward = 0.9}, 1e4, 1e-3);
  EXPECT_EQ(held.rim_ratio, 1e-3);
}

TEST(FreeWheel, GoingBackwardsItRollsBackwards) {
  RoverModel rover = six_wheeler();
  rover.wheels[4].drive = WheelDrive::kFree;
  const StationState state = level(rover, {.speed_m_s = -0.04});
  ASSERT_TRUE(state.moving());
  EXPECT_LT(state.wheels[4].rate_rad_s, 0.0);
  EXPECT_NEAR(state.wheels[4].torque_nm, 0.0, 1e-9);
}

TEST(DrivenWheel, DragCostsCurrentAndNothingElse) {
  RoverModel rover = six_wheeler();
  const StationState before = level(rover);
  for (WheelModel& wheel : rover.wheels) wheel.drag_nm = 0.7;
  const StationState after = level(rover);
  EXPECT_EQ(after.slip_ratio, before.slip_ratio);
  EXPECT_EQ(after.wheels[2].torque_nm, before.wheels[2].torque_nm);
  const DriveMotor& motor = rover.drive;
  EXPECT_NEAR(after.wheels[2].current_a - before.wheels[2].current_a,
              0.7 / (motor.torque_constant_nm_per_a * motor.gear_ratio * motor.gear_efficiency), 1e-12);
  const StationState backwards = level(rover, {.speed_m_s = -0.04});
  EXPECT_LT(backwards.wheels[2].current_a, 0.0);
}

TEST(DrivenWheel, AWheelThatTurnsSlowerThanCommandedYawsTheRoverToItsSide) {
  RoverModel rover = six_wheeler();
  for (int k = 0; k < 3; ++k) rover.wheels[k].rate_share = 0.9;
  const StationState state = level(rover);
  ASSERT_TRUE(state.moving());
  EXPECT_GT(state.yaw_rate_rad_s, 0.0);
  EXPECT_NEAR(state.wheels[0].rate_rad_s, 0.9 * state.wheels[3].rate_rad_s, 1e-12);
}

TEST(DrivenWheel, ASteeringOffsetPullsTheRoverThatWay) {
  RoverModel rover = six_wheeler();
  for (const int k : {0, 3}) rover.wheels[k].steering_offset_rad = rad_from_deg(4.0);
  EXPECT_GT(level(rover).yaw_rate_rad_s, 1e-4);
}

TEST(DrivenWheel, AColdMotorWithThickLubricantTakesMoreCurrent) {
  RoverModel rover = six_wheeler();
  rover.drive.friction_per_k = 0.01;
  const StationState warm = level(rover), cold = level(rover, {.motor_temp_c = -60.0});
  EXPECT_EQ(cold.slip_ratio, warm.slip_ratio);
  EXPECT_GT(cold.wheels[0].current_a, warm.wheels[0].current_a + 0.5 * rover.drive.no_load_current_a);
}

}  // namespace
}  // namespace slipway::sim
