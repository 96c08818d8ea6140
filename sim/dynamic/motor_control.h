#pragma once

#include "sim/rover/drive_command.h"
#include "sim/rover/motor.h"
#include "sim/rover/rover_model.h"

namespace slipway::sim {

// What keeps a motor from the voltage that its controller asks for.
enum class MotorLimit { kNone, kBusVoltage, kCurrent };

// The state of a motor under control at an instant.
struct MotorDrive {
  double voltage_v = 0.0;    // that the controller gives, within the bus voltage and the current limit
  double unclipped_v = 0.0;  // that it asks for
  double terminal_v = 0.0;   // as in motor.h: an assumed resistance drops no voltage
  MotorLimit limit = MotorLimit::kNone;
  double current_a = 0.0;
  double torque_nm = 0.0;         // at the wheel or the steering axis
  double electric_power_w = 0.0;  // from the bus, as in motor.h; an assumed resistance does not heat
};

// A DC motor behind its gear under voltage [ROAMS section 2.4], inductance neglected:
//
//   i = (V - k_t N w) / R     the torque is as in motor.h, with dry friction as tanh(w / standstill)
//
// Rate control of a drive motor, with e = w_commanded - w:
//
//   V = k_t N w_commanded + k_p e + V_i,     V_i' = k_i e + (V_clipped - V) kControl_rad_s
//
// Angle control of a steering motor:
//
//   V = k_p (a_commanded - a) - k_d a'
//
// The gains put both poles of the joint with its inertia at kControl_rad_s; where the back EMF alone damps
// more than that, only the slower pole.
//
// A motor whose resistance is not known has a stand-in for it (winding_resistance_ohm), which sets the gains
// but limits nothing: such a motor's torque ends at its current limit alone, and its rate where the back EMF
// is the bus voltage.
//
// While a rover is halted, brakes hold its wheels and the motors are off:
//
//   T = c_T (V_i - d w),     V_i' = -k w,     c_T = k_t N eta / R
//
// A brake is an elastic joint without a limit of its torque, with both poles at kBrake_rad_s. Its torque is
// stated as the integral voltage at which the motor has the same torque at rest, so that the motor takes over
// what the brake held, and the brake what the motor held.
class MotorControl {
 public:
  static constexpr double kControl_rad_s = 8.0;
  static constexpr double kBrake_rad_s = 20.0;

  // inertia_kg_m2 is that of everything that turns about the joint, armature included, and of the load that
  // it moves.
  MotorControl(const DriveMotor& motor, double inertia_kg_m2, double standstill_rad_s);

  MotorDrive keep_rate(double commanded_rad_s, double rate_rad_s, double integral_v) const;
  double integral_rate_v_s(const MotorDrive& drive, double commanded_rad_s, double rate_rad_s) const;
  // The brake's torque, and the rate of the integral voltage while it holds.
  double brake_torque_nm(double rate_rad_s, double integral_v) const;
  double brake_integral_rate_v_s(double rate_rad_s) const { return -brake_stiffness_v_rad_ * rate_rad_s; }
  MotorDrive keep_angle(double commanded_rad, double angle_rad, double rate_rad_s) const;

 private:
  MotorDrive driven_by(double voltage_v, double rate_rad_s) const;
  double back_emf_v(double rate_rad_s) const;

  DriveMotor motor_;
  double standstill_rad_s_;
  double max_rate_rad_s_;          // where the back EMF is the bus voltage
  double torque_per_volt_nm_ = 0;  // at rest
  double brake_stiffness_v_rad_ = 0.0, brake_damping_vs_rad_ = 0.0;
  double rate_gain_ = 0.0, integral_gain_ = 0.0;  // V s, V
  double angle_gain_ = 0.0, damping_gain_ = 0.0;  // V, V s
};

}  // namespace slipway::sim
