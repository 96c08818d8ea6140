#pragma once

#include "sim/rover/drive_command.h"
#include "sim/rover/motor.h"
#include "sim/rover/rover_model.h"

namespace slipway::sim {

// The state of a motor under control at an instant.
struct MotorDrive {
  double voltage_v = 0.0;    // at the motor, within the bus voltage and the current limit
  double unclipped_v = 0.0;  // that the controller asks for
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
class MotorControl {
 public:
  static constexpr double kControl_rad_s = 8.0;

  // inertia_kg_m2 is that of everything that turns about the joint, armature included, and of the load that
  // it moves.
  MotorControl(const DriveMotor& motor, double inertia_kg_m2, double standstill_rad_s);

  MotorDrive keep_rate(double commanded_rad_s, double rate_rad_s, double integral_v) const;
  double integral_rate_v_s(const MotorDrive& drive, double commanded_rad_s, double rate_rad_s) const;
  MotorDrive keep_angle(double commanded_rad, double angle_rad, double rate_rad_s) const;

 private:
  MotorDrive driven_by(double voltage_v, double rate_rad_s) const;
  double back_emf_v(double rate_rad_s) const;

  DriveMotor motor_;
  double standstill_rad_s_;
  double rate_gain_ = 0.0, integral_gain_ = 0.0;  // V s, V
  double angle_gain_ = 0.0, damping_gain_ = 0.0;  // V, V s
};

}  // namespace slipway::sim
