#include "sim/rover/motor.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace slipway::sim {
namespace {

double sign_of(double rate, double standstill) {
  if (standstill > 0.0) return std::tanh(rate / standstill);
  return rate > 0.0 ? 1.0 : rate < 0.0 ? -1.0 : 0.0;
}

// Current that turns the motor at a rate without any torque at its gear.
double idle_current_a(const DriveMotor& drive, double rate, double sign) {
  return drive.damping_nms_rad * drive.gear_ratio * rate / drive.torque_constant_nm_per_a +
         drive.no_load_current_a * sign;
}

// Friction of the gearbox, at the wheel.
double gearbox_nm(const DriveMotor& drive, double rate, double sign) {
  return drive.gear_friction_nm * sign + drive.gear_viscous_nms_rad * rate;
}

}  // namespace

DriveMotor at_temperature(const DriveMotor& drive, double motor_temp_c) {
  const double above = motor_temp_c - drive.reference_temp_c;
  DriveMotor there = drive;
  there.torque_constant_nm_per_a *= std::max(0.1, 1.0 - drive.torque_constant_per_k * above);
  if (drive.resistance_ohm)
    there.resistance_ohm = *drive.resistance_ohm * std::max(0.1, 1.0 + drive.resistance_per_k * above);
  const double friction = std::max(0.1, 1.0 - drive.friction_per_k * above);
  there.no_load_current_a *= friction;
  there.damping_nms_rad *= friction;
  there.gear_friction_nm *= friction;
  there.gear_viscous_nms_rad *= friction;
  return there;
}

MotorState motor_state(const DriveMotor& drive, double torque_nm, double wheel_rate_rad_s) {
  const double geared = drive.torque_constant_nm_per_a * drive.gear_ratio;
  const double sign = sign_of(wheel_rate_rad_s, 0.0);
  const double at_gear = torque_nm + gearbox_nm(drive, wheel_rate_rad_s, sign);
  const bool driven_back = at_gear * sign < 0.0 && !drive.currents_by_format;
  MotorState state;
  state.current_a =
      at_gear / (driven_back ? geared / drive.gear_efficiency : geared * drive.gear_efficiency) +
      idle_current_a(drive, wheel_rate_rad_s, sign);
  state.voltage_v = drive.resistance_ohm.value_or(0.0) * state.current_a + geared * wheel_rate_rad_s;
  state.electric_power_w = std::max(0.0, state.voltage_v * state.current_a);
  return state;
}

double torque_of_current_nm(const DriveMotor& drive, double current_a, double wheel_rate_rad_s,
                            double standstill_rad_s) {
  const double geared = drive.torque_constant_nm_per_a * drive.gear_ratio;
  const double sign = sign_of(wheel_rate_rad_s, standstill_rad_s);
  const double motor_a = current_a - idle_current_a(drive, wheel_rate_rad_s, sign);
  double passed = drive.gear_efficiency;
  if (motor_a * sign < 0.0 && !drive.currents_by_format)
    passed += std::abs(sign) * (1.0 / drive.gear_efficiency - drive.gear_efficiency);
  return motor_a * geared * passed - gearbox_nm(drive, wheel_rate_rad_s, sign);
}

double winding_resistance_ohm(const DriveMotor& drive) {
  if (drive.resistance_ohm) return *drive.resistance_ohm;
  const double back_emf = drive.torque_constant_nm_per_a * drive.gear_ratio * drive.max_wheel_rate_rad_s;
  const double left_v = std::max(drive.bus_voltage_v - back_emf, 0.1 * drive.bus_voltage_v);
  return left_v / std::max(20.0 * drive.no_load_current_a, 10.0);
}

bool stalls(const DriveMotor& drive, const MotorState& state) {
  return (drive.max_current_a && std::abs(state.current_a) > *drive.max_current_a) ||
         std::abs(state.voltage_v) > drive.bus_voltage_v;
}

double stall_torque_nm(const DriveMotor& drive) {
  double most = std::numeric_limits<double>::infinity();
  if (drive.resistance_ohm) most = drive.bus_voltage_v / *drive.resistance_ohm;
  if (drive.max_current_a) most = std::min(most, *drive.max_current_a);
  const double geared = drive.torque_constant_nm_per_a * drive.gear_ratio * drive.gear_efficiency;
  return std::max(0.0, (most - drive.no_load_current_a) * geared - drive.gear_friction_nm);
}

double attainable_rate_rad_s(const DriveMotor& drive, double torque_nm) {
  const double most = drive.max_wheel_rate_rad_s;
  if (!(torque_nm < stall_torque_nm(drive))) return 0.0;
  // Voltage is linear in the rate for rates above zero: V(w) = V0 + slope w.
  const double tiny = 1e-9 * most;
  const double v0 = motor_state(drive, torque_nm, tiny).voltage_v;
  const double slope = (motor_state(drive, torque_nm, most).voltage_v - v0) / (most - tiny);
  if (v0 + slope * most > drive.bus_voltage_v)
    return std::clamp((drive.bus_voltage_v - v0) / slope, 0.0, most);
  // Current rises with the rate through damping alone.
  if (drive.max_current_a && motor_state(drive, torque_nm, most).current_a > *drive.max_current_a) {
    const double i0 = motor_state(drive, torque_nm, tiny).current_a;
    const double rise = (motor_state(drive, torque_nm, most).current_a - i0) / (most - tiny);
    return std::clamp((*drive.max_current_a - i0) / rise, 0.0, most);
  }
  return most;
}

}  // namespace slipway::sim
