#include "sim/dynamic/motor_control.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/angle.h"
#include "sim/dynamic/leg_driver.h"
#include "tests/sim/reference_models.h"

namespace slipway::sim {
namespace {

// A wheel of this inertia against a constant load, by small explicit steps.
double rate_after(const DriveMotor& motor, double commanded, double load_nm, double inertia, double seconds) {
  const MotorControl control(motor, inertia, 0.003);
  double rate = 0.0, integral = 0.0;
  constexpr double kStep_s = 1e-4;
  for (double t = 0.0; t < seconds; t += kStep_s) {
    const MotorDrive drive = control.keep_rate(commanded, rate, integral);
    integral += kStep_s * control.integral_rate_v_s(drive, commanded, rate);
    rate += kStep_s * drive.torque_nm / inertia;
    // Dry friction takes what it can, and turns nothing round: an explicit step would chatter.
    const double taken = kStep_s * load_nm / inertia;
    rate -= std::clamp(rate, -taken, taken);
  }
  return rate;
}

TEST(MotorControl, KeepsItsRateUnderLoad) {
  EXPECT_NEAR(rate_after(DriveMotor{}, 0.3, 0.0, 2.0, 3.0), 0.3, 1e-4);
  EXPECT_NEAR(rate_after(DriveMotor{}, 0.3, 15.0, 2.0, 6.0), 0.3, 1e-3);
  EXPECT_NEAR(rate_after(DriveMotor{}, -0.3, 15.0, 2.0, 6.0), -0.3, 1e-3);
}

TEST(MotorControl, StaysWithinTheBusVoltage) {
  DriveMotor motor;
  motor.resistance_ohm = 2.0;
  const MotorDrive drive = MotorControl(motor, 1.0, 0.003).keep_rate(100.0, 0.0, 5.0);
  EXPECT_EQ(drive.voltage_v, motor.bus_voltage_v);
  EXPECT_GT(drive.unclipped_v, drive.voltage_v);
  EXPECT_NEAR(drive.current_a, motor.bus_voltage_v / winding_resistance_ohm(motor), 1e-12);
}

// A resistance that no file gives sets the gains and limits nothing.
TEST(MotorControl, AStandInForTheResistanceLimitsNoTorque) {
  DriveMotor motor;
  const MotorControl control(motor, 1.0, 0.003);
  const double strong_nm = 10.0 * motor.bus_voltage_v / winding_resistance_ohm(motor) *
                           motor.torque_constant_nm_per_a * motor.gear_ratio * motor.gear_efficiency;
  EXPECT_NEAR(rate_after(motor, 0.2, strong_nm, 2.0, 120.0), 0.2, 1e-3);
  const MotorDrive strong = control.keep_rate(0.2, 0.0, 20.0 * motor.bus_voltage_v);
  EXPECT_GT(strong.torque_nm, strong_nm);
  EXPECT_EQ(strong.limit, MotorLimit::kNone);
  EXPECT_EQ(strong.terminal_v, 0.0);
  // The bus voltage limits its rate all the same.
  const double fastest = motor.bus_voltage_v / (motor.torque_constant_nm_per_a * motor.gear_ratio);
  EXPECT_NEAR(rate_after(motor, 5.0 * fastest, 0.0, 2.0, 8.0), fastest, 1e-3 * fastest);
}

// Whatever presses on a braked wheel, it turns by the brake's elasticity and stays there.
TEST(MotorControl, ABrakeHoldsAndHandsItsTorqueToTheMotor) {
  const DriveMotor motor;
  constexpr double kInertia = 2.0, kLoad_nm = 300.0, kStep_s = 1e-4;
  const MotorControl control(motor, kInertia, 0.003);
  double rate = 0.0, angle = 0.0, integral = 0.0;
  for (double t = 0.0; t < 3.0; t += kStep_s) {
    const double torque = control.brake_torque_nm(rate, integral);
    integral += kStep_s * control.brake_integral_rate_v_s(rate);
    rate += kStep_s * (torque - kLoad_nm) / kInertia;
    angle += kStep_s * rate;
  }
  EXPECT_NEAR(rate, 0.0, 1e-9);
  EXPECT_NEAR(angle, -kLoad_nm / (kInertia * std::pow(MotorControl::kBrake_rad_s, 2)), 1e-4);
  EXPECT_NEAR(control.keep_rate(0.0, 0.0, integral).torque_nm, kLoad_nm, 1e-6);
}

TEST(MotorControl, StaysWithinTheCurrentLimit) {
  DriveMotor motor;
  motor.max_current_a = 0.5;
  for (const double rate : {-0.3, 0.0, 0.3})
    EXPECT_LE(std::abs(MotorControl(motor, 1.0, 0.003).keep_rate(0.4, rate, 20.0).current_a), 0.5 + 1e-12);
}

// As in motor.h, a resistance that no file gives causes no heat, however slowly the rover creeps.
TEST(MotorControl, TakesTheSamePowerAsTheMotorsLaw) {
  for (const bool known : {false, true}) {
    DriveMotor motor;
    if (known) motor.resistance_ohm = 1.5;
    const double commanded = 0.1;
    for (const double integral_v : {-0.5, 0.0, 0.5, 4.0}) {
      const MotorDrive drive = MotorControl(motor, 1.0, 1e-4).keep_rate(commanded, commanded, integral_v);
      EXPECT_NEAR(drive.electric_power_w, motor_state(motor, drive.torque_nm, commanded).electric_power_w,
                  1e-9)
          << known << " " << integral_v;
    }
  }
}

TEST(LegDriver, CommandedRatesCoverTheCommandedLength) {
  const RoverModel rover = six_wheeler();
  DriveLeg leg;
  leg.command = {.speed_m_s = 0.04, .curvature_1_m = 0.3};
  leg.length_m = 1.7;
  const LegDriver driver(rover, leg, Feedback::kNone, 5.0, PerWheel<double>(6));
  double driven_m = 0.0;
  constexpr double kStep_s = 1e-3;
  for (double t = 5.0; t < driver.end_s(); t += kStep_s) driven_m += kStep_s * 0.04 * driver.rate_share(t);
  EXPECT_NEAR(driven_m, 1.7, 1e-3);
  EXPECT_EQ(driver.rate_share(5.0), 0.0);
  EXPECT_NEAR(driver.rate_share(driver.end_s()), 0.0, 1e-12);
}

TEST(LegDriver, SteersBeforeItDrivesAndNoFasterThanItsMotorsCan) {
  const RoverModel rover = six_wheeler();
  DriveLeg leg;
  leg.command = {.speed_m_s = 0.04, .curvature_1_m = 0.5};
  leg.length_m = 1.0;
  const LegDriver driver(rover, leg, Feedback::kNone, 0.0, PerWheel<double>(6));
  const PerWheel<WheelCommand> commanded = wheel_commands(rover, leg.command);
  double last = 0.0;
  for (double t = 0.0; t < driver.steered_s(); t += 0.01) {
    const PerWheel<WheelCommand> now = driver.commanded(t, {});
    EXPECT_EQ(now[0].rate_rad_s, 0.0);
    EXPECT_LE(std::abs(now[0].steer_rad - last), 0.1 * 0.01 + 1e-9);
    last = now[0].steer_rad;
  }
  EXPECT_NEAR(driver.commanded(driver.steered_s(), {})[0].steer_rad, commanded[0].steer_rad, 1e-9);
}

// A rover left of its line is steered right, whichever way it drives.
TEST(LegDriver, SteersBackToItsLine) {
  const RoverModel rover = six_wheeler();
  for (const double speed : {0.04, -0.04}) {
    DriveLeg leg;
    leg.command.speed_m_s = speed;
    leg.length_m = 5.0;
    const LegDriver driver(rover, leg, Feedback::kPose, 0.0, PerWheel<double>(6));
    const PerWheel<WheelCommand> commanded =
        driver.commanded(10.0, {.share = 0.5, .across_m = 0.2, .heading_rad = 0.0});
    // Its path then bends to the right of its travel: the leading steered wheel points there.
    const std::size_t leading = speed > 0.0 ? 0 : 2;
    EXPECT_LT(commanded[leading].steer_rad, 0.0);
  }
}

// A kinematic rover from any distance and heading: it comes to its line, and never circles.
TEST(LegDriver, BringsARoverBackFromAnyDistanceAndHeading) {
  const RoverModel rover = six_wheeler();
  const double l = rover.body_length_m, limit = 0.5 / rover.min_turn_radius_m, step = 0.02;
  for (const double across : {-40.0, -8.0, -1.0, 0.3, 5.0, 20.0}) {
    for (const double heading : {-3.0, -1.5, 0.0, 1.0, 2.5}) {
      double e = across, psi = heading, ahead = 0.0;
      for (double way = 0.0; way < 2.0 * std::abs(across) + 30.0; way += step) {
        const double to_line = heading_to_line_rad(rover, {.across_m = e});
        psi -= step * limit * std::tanh(2.0 * wrapped_rad(psi - to_line) / l / limit);
        e += step * std::sin(psi);
        ahead += step * std::cos(psi);
      }
      EXPECT_NEAR(e, 0.0, 0.02) << across << " " << heading;
      EXPECT_NEAR(wrapped_rad(psi), 0.0, 0.02) << across << " " << heading;
      EXPECT_GT(ahead, 0.5 * std::abs(across)) << "at 45 deg it gets on along the line too";
    }
  }
}

// Steered back to a line that it crabs along at a quarter turn, a wheel would swing half a turn and roll the
// other way.
TEST(LegDriver, RollsOnPastAQuarterTurn) {
  const RoverModel rover = six_wheeler();
  for (const double crab_deg : {90.0, -90.0, 88.0}) {
    DriveLeg leg;
    leg.command = {.speed_m_s = 0.04, .crab_rad = rad_from_deg(crab_deg)};
    leg.length_m = 5.0;
    const LegDriver driver(rover, leg, Feedback::kPose, 0.0, PerWheel<double>(6));
    const double t = driver.ramped_s() + 1.0;
    const PerWheel<WheelCommand> plain = wheel_commands(rover, leg.command);
    for (const double across : {-0.2, 0.2}) {
      const PerWheel<WheelCommand> commanded = driver.commanded(t, {.share = 0.5, .across_m = across});
      for (std::size_t k = 0; k < commanded.size(); ++k) {
        EXPECT_LT(std::abs(commanded[k].steer_rad - plain[k].steer_rad), 0.5 * std::numbers::pi) << k;
        if (!rover.wheels[k].steerable) continue;
        EXPECT_GT(commanded[k].rate_rad_s * plain[k].rate_rad_s, 0.0) << k;
      }
    }
  }
}

}  // namespace
}  // namespace slipway::sim
