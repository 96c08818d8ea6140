#include "sim/rover/motor.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sim/rover/wheel_failure.h"

namespace slipway::sim {
namespace {

DriveMotor motor() {
  DriveMotor drive;
  drive.resistance_ohm = 4.0;
  drive.damping_nms_rad = 1e-7;
  drive.gear_friction_nm = 0.4;
  drive.gear_viscous_nms_rad = 2.0;
  return drive;
}

TEST(Motor, CurrentIsThatOfTheDriveCampaignFormatWithoutFrictionOfItsOwn) {
  DriveMotor drive;
  const double geared = drive.torque_constant_nm_per_a * drive.gear_ratio * drive.gear_efficiency;
  EXPECT_DOUBLE_EQ(motor_state(drive, 5.0, 0.3).current_a, 5.0 / geared + drive.no_load_current_a);
  EXPECT_DOUBLE_EQ(motor_state(drive, -5.0, -0.3).current_a, -5.0 / geared - drive.no_load_current_a);
  EXPECT_EQ(motor_state(drive, 0.0, 0.0).current_a, 0.0);
}

TEST(Motor, VoltageObeysKirchhoff) {
  const DriveMotor drive = motor();
  const MotorState state = motor_state(drive, 6.0, 0.3);
  const double back_emf = drive.torque_constant_nm_per_a * drive.gear_ratio * 0.3;
  EXPECT_NEAR(state.voltage_v - back_emf, 4.0 * state.current_a, 1e-12);
  EXPECT_NEAR(state.electric_power_w, state.voltage_v * state.current_a, 1e-12);
}

TEST(Motor, PowerIntoTheMotorIsWorkHeatAndFriction) {
  const DriveMotor drive = motor();
  const double torque = 6.0, rate = 0.3;
  const MotorState s = motor_state(drive, torque, rate);
  const double heat = 4.0 * s.current_a * s.current_a;
  const double k = drive.torque_constant_nm_per_a * drive.gear_ratio;
  const double shaft = k * s.current_a * rate;  // electric power turned into motion
  EXPECT_NEAR(s.electric_power_w, heat + shaft, 1e-12);
  const double damping = drive.damping_nms_rad * std::pow(drive.gear_ratio * rate, 2);
  const double gearbox = (drive.gear_friction_nm + drive.gear_viscous_nms_rad * rate) * rate;
  const double idle = k * drive.no_load_current_a * rate;
  EXPECT_NEAR(shaft, (torque * rate + gearbox) / drive.gear_efficiency + damping + idle, 1e-12);
}

TEST(Motor, TorqueOfCurrentIsTheInverseOfCurrent) {
  const DriveMotor drive = motor();
  for (const double torque : {-8.0, 0.0, 3.0, 20.0})
    for (const double rate : {-0.3, 0.2})
      EXPECT_NEAR(torque_of_current_nm(drive, motor_state(drive, torque, rate).current_a, rate), torque,
                  1e-10);
}

// Over torques, rates and motors: what flows back is what the ground gave less the losses, and current is
// continuous and rising in the torque where the gear turns from driving to being driven.
TEST(Motor, RegenerationReturnsNoMoreThanTheGroundGave) {
  for (const double efficiency : {0.2, 0.55, 1.0})
    for (const double rate : {-0.3, 1e-3, 0.2}) {
      DriveMotor drive = motor();
      drive.gear_efficiency = efficiency;
      double before = motor_state(drive, -40.0, rate).current_a;
      for (double torque = -40.0; torque <= 40.0; torque += 0.125) {
        const MotorState state = motor_state(drive, torque, rate);
        EXPECT_GE(state.voltage_v * state.current_a, torque * rate - 1e-12) << efficiency << " " << torque;
        EXPECT_NEAR(torque_of_current_nm(drive, state.current_a, rate), torque, 1e-9);
        EXPECT_GE(state.current_a, before);
        EXPECT_LE(state.current_a - before, 0.126 / (0.0224 * 1500.0 * efficiency));
        before = state.current_a;
      }
    }
}

// The format's equation, for drives whose currents were computed by it.
TEST(Motor, CurrentsByFormatAreThoseOfTheFormatUnderABrakingTorqueToo) {
  DriveMotor drive;
  drive.currents_by_format = true;
  const double geared = drive.torque_constant_nm_per_a * drive.gear_ratio * drive.gear_efficiency;
  EXPECT_DOUBLE_EQ(motor_state(drive, -5.0, 0.3).current_a, -5.0 / geared + drive.no_load_current_a);
  EXPECT_NEAR(torque_of_current_nm(drive, motor_state(drive, -5.0, 0.3).current_a, 0.3), -5.0, 1e-12);
  EXPECT_NEAR(unpowered_drag_nm(drive), 0.06 * geared, 1e-9);
}

TEST(Motor, StallTorqueTakesTheWholeBusVoltageAtStandstill) {
  const DriveMotor drive = motor();
  const double most = stall_torque_nm(drive);
  EXPECT_FALSE(stalls(drive, motor_state(drive, 0.999 * most, 1e-9)));
  EXPECT_TRUE(stalls(drive, motor_state(drive, 1.001 * most, 1e-9)));
  EXPECT_EQ(attainable_rate_rad_s(drive, 1.001 * most), 0.0);
}

TEST(Motor, TheAttainableRateUsesTheBusVoltageUnderHeavyTorqueAndIsTheMaximumUnderNone) {
  DriveMotor drive = motor();
  EXPECT_EQ(attainable_rate_rad_s(drive, 0.0), drive.max_wheel_rate_rad_s);
  const double torque = 0.9 * stall_torque_nm(drive);
  const double rate = attainable_rate_rad_s(drive, torque);
  EXPECT_LT(rate, drive.max_wheel_rate_rad_s);
  EXPECT_NEAR(motor_state(drive, torque, rate).voltage_v, drive.bus_voltage_v, 1e-6);
}

TEST(Motor, ACurrentLimitStallsBeforeTheVoltageDoes) {
  DriveMotor drive = motor();
  drive.max_current_a = 0.5;
  EXPECT_TRUE(stalls(drive, motor_state(drive, 0.6 * 0.0224 * 1500 * 0.55, 0.1)));
  EXPECT_LT(stall_torque_nm(drive), stall_torque_nm(motor()));
}

TEST(Motor, AColdMotorHasMoreTorquePerAmpereAndMoreFriction) {
  DriveMotor drive = motor();
  drive.torque_constant_per_k = 0.0011;
  drive.friction_per_k = 0.02;
  drive.resistance_per_k = 0.0039;
  const DriveMotor same = at_temperature(drive, drive.reference_temp_c);
  EXPECT_EQ(motor_state(same, 4.0, 0.2).current_a, motor_state(drive, 4.0, 0.2).current_a);
  const DriveMotor cold = at_temperature(drive, drive.reference_temp_c - 60.0);
  EXPECT_DOUBLE_EQ(cold.torque_constant_nm_per_a, drive.torque_constant_nm_per_a * 1.066);
  EXPECT_DOUBLE_EQ(cold.no_load_current_a, drive.no_load_current_a * 2.2);
  EXPECT_DOUBLE_EQ(*cold.resistance_ohm, *drive.resistance_ohm * (1.0 - 0.0039 * 60.0));
  EXPECT_GT(at_temperature(drive, 200.0).no_load_current_a, 0.0);
}

}  // namespace
}  // namespace slipway::sim
