#include "sim/rover/rover_model.h"

#include <gtest/gtest.h>

#include "sim/rover/drive_command.h"
#include "sim/rover/motor.h"
#include "tests/sim/reference_models.h"

namespace slipway::sim {
namespace {

TEST(RoverModel, TheReferenceModelHasNoFaults) {
  EXPECT_TRUE(faults_of(six_wheeler()).empty());
}

TEST(RoverModel, EveryFaultIsReportedAtOnceWithItsPlace) {
  RoverModel rover = six_wheeler();
  rover.mass_kg = -3.0;
  rover.wheels[2].radius_m = 0.0;
  rover.com_m.x() = 5.0;
  rover.drive.gear_efficiency = 1.5;
  std::vector<std::string> pointers;
  for (const Fault& fault : faults_of(rover)) pointers.push_back(fault.pointer);
  EXPECT_EQ(pointers,
            (std::vector<std::string>{"/wheels/2/radius_m", "/mass_kg", "/com_m", "/drive/gear_efficiency"}));
}

std::vector<std::string> pointers_of(const RoverModel& rover) {
  std::vector<std::string> pointers;
  for (const Fault& fault : faults_of(rover)) pointers.push_back(fault.pointer);
  return pointers;
}

TEST(RoverModel, ThreeToTwelveWheelsOnTheSuspensionsThatFitThemHaveNoFaults) {
  EXPECT_TRUE(faults_of(three_wheeler()).empty());
  EXPECT_TRUE(faults_of(four_wheeler(SuspensionType::kAveraging)).empty());
  for (const int columns : {2, 3, 4, 6})
    EXPECT_TRUE(faults_of(even_wheeler(SuspensionType::kRigid, columns)).empty()) << columns;
  EXPECT_EQ(pointers_of(even_wheeler(SuspensionType::kRigid, 7)).front(), "/wheels");
}

TEST(RoverModel, ARockerBogieHasSixWheelsAndAnAveragingRockerTwoBehindEachOther) {
  EXPECT_EQ(pointers_of(four_wheeler(SuspensionType::kRockerBogie)), std::vector<std::string>{"/wheels"});
  RoverModel tripod = three_wheeler();
  tripod.suspension.type = SuspensionType::kAveraging;
  EXPECT_EQ(pointers_of(tripod), std::vector<std::string>{"/suspension/type"});
  RoverModel disordered = six_wheeler();
  std::swap(disordered.wheels[0].name, disordered.wheels[1].name);
  EXPECT_EQ(pointers_of(disordered), (std::vector<std::string>{"/wheels/0/name", "/wheels/1/name"}));
}

TEST(RoverModel, WheelsHaveNamesOfTheirOwn) {
  RoverModel rover = three_wheeler();
  rover.wheels[1].name = rover.wheels[0].name;
  rover.wheels[2].name = "much_too_long";
  EXPECT_EQ(pointers_of(rover), (std::vector<std::string>{"/wheels/1/name", "/wheels/2/name"}));
}

TEST(RoverModel, TheCentreOfMassOfATripodLiesInItsTriangle) {
  RoverModel rover = three_wheeler();
  rover.com_m = {-0.5, 0.4, 0.35};  // between front and rear, left and right, but beside the tail
  EXPECT_EQ(pointers_of(rover), std::vector<std::string>{"/com_m"});
}

TEST(RoverModel, WheelsAndSuspensionLeaveTheBodyATenthOfTheMass) {
  RoverModel rover = six_wheeler();
  rover.masses.wheel_kg = 0.12 * rover.mass_kg;  // with rockers and bogies 82 %
  EXPECT_TRUE(faults_of(rover).empty());
  rover.masses.wheel_kg = 0.14 * rover.mass_kg;  // 94 %
  EXPECT_EQ(pointers_of(rover), std::vector<std::string>{"/masses"});
  RoverModel rigid = four_wheeler(SuspensionType::kRigid);
  rigid.masses.wheel_kg = 0.2 * rigid.mass_kg;
  rigid.masses.rocker_kg = rigid.mass_kg;  // which it does not have
  EXPECT_TRUE(faults_of(rigid).empty());
}

TEST(RoverModel, ABodysMomentsOfInertiaAreThoseOfABody) {
  RoverModel rover = six_wheeler();
  rover.masses.body_inertia_kg_m2 = Eigen::Vector3d(10.0, 20.0, 31.0);
  EXPECT_EQ(pointers_of(rover), std::vector<std::string>{"/masses/body_inertia_kg_m2"});
  rover.masses.body_inertia_kg_m2 = Eigen::Vector3d(10.0, 20.0, 29.0);
  EXPECT_TRUE(faults_of(rover).empty());
}

TEST(RoverModel, ParametersOfTheDynamicLevelHaveRangesToo) {
  RoverModel rover = six_wheeler();
  rover.suspension.differential_stiffness_nm_rad = -1.0;
  rover.suspension.bogie_stop_rad = 3.0;
  rover.drive.rotor_inertia_kg_m2 = -1.0;
  rover.steering = rover.drive;
  rover.steering->gear_ratio = 0.0;
  EXPECT_EQ(pointers_of(rover),
            (std::vector<std::string>{"/suspension/differential_stiffness_nm_per_deg",
                                      "/suspension/bogie_stop_deg", "/drive/rotor_inertia_kg_m2",
                                      "/steering/gear_ratio", "/steering/rotor_inertia_kg_m2"}));
}

TEST(WheelCommands, StraightDrivingTurnsAllWheelsAlike) {
  for (const WheelCommand& wheel : wheel_commands(six_wheeler(), {.speed_m_s = 0.04})) {
    EXPECT_EQ(wheel.steer_rad, 0.0);
    EXPECT_NEAR(wheel.rate_rad_s, 0.04 / 0.125, 1e-15);
  }
}

TEST(WheelCommands, OnAnArcEveryWheelPointsAcrossTheTurnsCentre) {
  const RoverModel rover = six_wheeler();
  const double curvature = 0.4;
  const auto commanded = wheel_commands(rover, {.speed_m_s = 0.03, .curvature_1_m = curvature});
  for (int k = 0; k < 6; ++k) {
    if (!rover.wheels[k].steerable) continue;
    const Eigen::Vector2d to_centre(-rover.wheels[k].position_m.x(),
                                    1.0 / curvature - rover.wheels[k].position_m.y());
    const Eigen::Vector2d heading(std::cos(commanded[k].steer_rad), std::sin(commanded[k].steer_rad));
    EXPECT_NEAR(heading.dot(to_centre), 0.0, 1e-12);
    EXPECT_NEAR(commanded[k].rate_rad_s * rover.wheels[k].radius_m, 0.03 * curvature * to_centre.norm(),
                1e-12);
  }
}

TEST(WheelCommands, ASpeedBeyondTheMotorsIsScaledDownForAllWheelsTogether) {
  const RoverModel rover = six_wheeler();
  const DriveCommand fast{.speed_m_s = 1.0, .curvature_1_m = 0.3};
  const auto commanded = wheel_commands(rover, fast);
  double fastest = 0.0;
  for (const WheelCommand& wheel : commanded) fastest = std::max(fastest, std::abs(wheel.rate_rad_s));
  EXPECT_NEAR(fastest, rover.drive.max_wheel_rate_rad_s, 1e-12);
  EXPECT_LT(attainable_share(rover, fast), 0.1);
  EXPECT_EQ(attainable_share(rover, {.speed_m_s = 0.04}), 1.0);
}

TEST(Motor, CurrentFollowsTheDriveCampaignsFormula) {
  DriveMotor drive;
  const MotorState state = motor_state(drive, 3.0, 0.3);
  EXPECT_NEAR(state.current_a, 3.0 / (0.0224 * 1500.0 * 0.55) + 0.06, 1e-12);
  EXPECT_NEAR(motor_state(drive, -3.0, -0.3).current_a, -state.current_a, 1e-12);
}

TEST(Motor, TheBusPaysForTheMechanicalPowerAndTheLosses) {
  DriveMotor drive;
  drive.resistance_ohm = 2.0;
  const MotorState state = motor_state(drive, 3.0, 0.3);
  EXPECT_GT(state.electric_power_w, 3.0 * 0.3);
  EXPECT_NEAR(state.electric_power_w, state.current_a * (2.0 * state.current_a + 0.0224 * 1500.0 * 0.3),
              1e-12);
  EXPECT_EQ(motor_state(drive, -5.0, 0.3).electric_power_w, 0.0)
      << "a wheel driven by the ground returns nothing";
}

TEST(Motor, StallIsTooMuchCurrentOrTooMuchVoltage) {
  DriveMotor drive;
  EXPECT_FALSE(stalls(drive, motor_state(drive, 3.0, 0.3)));
  drive.max_current_a = 0.2;
  EXPECT_TRUE(stalls(drive, motor_state(drive, 3.0, 0.3)));
  drive.max_current_a.reset();
  drive.bus_voltage_v = 5.0;
  EXPECT_TRUE(stalls(drive, motor_state(drive, 3.0, 0.3)));
}

}  // namespace
}  // namespace slipway::sim
