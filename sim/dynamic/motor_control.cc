#include "sim/dynamic/motor_control.h"

#include <algorithm>
#include <limits>

namespace slipway::sim {

MotorControl::MotorControl(const DriveMotor& motor, double inertia, double standstill_rad_s)
    : motor_(motor),
      standstill_rad_s_(standstill_rad_s),
      max_rate_rad_s_(motor.bus_voltage_v / (motor.torque_constant_nm_per_a * motor.gear_ratio)) {
  const double emf = back_emf_v(1.0);
  const double per_volt = emf * motor.gear_efficiency / winding_resistance_ohm(motor);
  torque_per_volt_nm_ = per_volt;
  brake_stiffness_v_rad_ = kBrake_rad_s * kBrake_rad_s * inertia / per_volt;
  brake_damping_vs_rad_ = 2.0 * kBrake_rad_s * inertia / per_volt;
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
  const double emf = back_emf_v(rate), resistance = winding_resistance_ohm(motor_);
  double high = std::numeric_limits<double>::infinity(), low = -high;
  if (motor_.resistance_ohm) {
    high = motor_.bus_voltage_v;
    low = -high;
  }
  MotorDrive out;
  out.unclipped_v = wanted_v;
  out.voltage_v = std::clamp(wanted_v, low, high);
  if (out.voltage_v != wanted_v) out.limit = MotorLimit::kBusVoltage;
  if (motor_.max_current_a) {
    const double room = *motor_.max_current_a * resistance;
    high = std::min(high, emf + room);
    low = std::min(high, std::max(low, emf - room));
    const double within = std::clamp(out.voltage_v, low, high);
    if (within != out.voltage_v) out.limit = MotorLimit::kCurrent;
    out.voltage_v = within;
  }
  out.current_a = (out.voltage_v - emf) / resistance;
  out.torque_nm = torque_of_current_nm(motor_, out.current_a, rate, standstill_rad_s_);
  out.terminal_v = emf + motor_.resistance_ohm.value_or(0.0) * out.current_a;
  out.electric_power_w = std::max(0.0, out.terminal_v * out.current_a);
  return out;
}

MotorDrive MotorControl::keep_rate(double commanded, double rate, double integral_v) const {
  commanded = std::clamp(commanded, -max_rate_rad_s_, max_rate_rad_s_);
  return driven_by(back_emf_v(commanded) + rate_gain_ * (commanded - rate) + integral_v, rate);
}

double MotorControl::integral_rate_v_s(const MotorDrive& drive, double commanded, double rate) const {
  commanded = std::clamp(commanded, -max_rate_rad_s_, max_rate_rad_s_);
  return integral_gain_ * (commanded - rate) + kControl_rad_s * (drive.voltage_v - drive.unclipped_v);
}

double MotorControl::brake_torque_nm(double rate, double integral_v) const {
  return torque_per_volt_nm_ * (integral_v - brake_damping_vs_rad_ * rate);
}

MotorDrive MotorControl::keep_angle(double commanded_rad, double angle_rad, double rate) const {
  return driven_by(angle_gain_ * (commanded_rad - angle_rad) - damping_gain_ * rate, rate);
}

}  // namespace slipway::sim
