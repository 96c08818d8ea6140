#include "sim/dynamic/motor_control.h"

#include <algorithm>

namespace slipway::sim {

MotorControl::MotorControl(const DriveMotor& motor, double inertia, double standstill_rad_s)
    : motor_(motor), standstill_rad_s_(standstill_rad_s) {
  const double emf = back_emf_v(1.0);
  const double per_volt = emf * motor.gear_efficiency / winding_resistance_ohm(motor);
  // The back EMF alone may damp more than two poles at kControl_rad_s need; then only the slower one is
  // there.
  const double damped_1_s = std::max(2.0 * kControl_rad_s, emf * per_volt / inertia);
  const double damping = damped_1_s * inertia / per_volt - emf;
  const double stiffness = kControl_rad_s * (damped_1_s - kControl_rad_s) * inertia / per_volt;
  rate_gain_ = damping_gain_ = damping;
  integral_gain_ = angle_gain_ = stiffness;
}

double MotorControl::back_emf_v(double rate) const {
  return motor_.torque_constant_nm_per_a * motor_.gear_ratio * rate;
}

MotorDrive MotorControl::driven_by(double wanted_v, double rate) const {
  double low = -motor_.bus_voltage_v, high = motor_.bus_voltage_v;
  const double emf = back_emf_v(rate), resistance = winding_resistance_ohm(motor_);
  if (motor_.max_current_a) {
    low = std::max(low, emf - *motor_.max_current_a * resistance);
    high = std::min(high, emf + *motor_.max_current_a * resistance);
  }
  MotorDrive out;
  out.unclipped_v = wanted_v;
  out.voltage_v = std::clamp(wanted_v, std::min(low, high), high);
  out.current_a = (out.voltage_v - emf) / resistance;
  out.torque_nm = torque_of_current_nm(motor_, out.current_a, rate, standstill_rad_s_);
  const double heated_v = motor_.resistance_ohm.value_or(0.0) * out.current_a;
  out.electric_power_w = std::max(0.0, (emf + heated_v) * out.current_a);
  return out;
}

MotorDrive MotorControl::keep_rate(double commanded, double rate, double integral_v) const {
  return driven_by(back_emf_v(commanded) + rate_gain_ * (commanded - rate) + integral_v, rate);
}

double MotorControl::integral_rate_v_s(const MotorDrive& drive, double commanded, double rate) const {
  return integral_gain_ * (commanded - rate) + kControl_rad_s * (drive.voltage_v - drive.unclipped_v);
}

MotorDrive MotorControl::keep_angle(double commanded_rad, double angle_rad, double rate) const {
  return driven_by(angle_gain_ * (commanded_rad - angle_rad) - damping_gain_ * rate, rate);
}

}  // namespace slipway::sim
