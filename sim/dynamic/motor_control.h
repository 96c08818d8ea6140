#pragma once

#include "sim/rover/drive_command.h"
#include "sim/rover/motor.h"
#include "sim/rover/rover_model.h"

namespace slipway::sim {

// What a motor's controller does at an instant.
struct MotorDrive {
  double voltage_v = 0.0;    // at the motor, within the bus voltage and the current limit
  double unclipped_v = 0.0;  // what the controller asks for
  double current_a = 0.0;
  double torque_nm = 0.0;         // at the wheel or the steering's axis
  double electric_power_w = 0.0;  // from the bus, as in motor.h: without a resistance that only stands in
};

// A DC motor behind its gear under voltage [ROAMS section 2.4], inductance neglected:
//
//   i = (V - k_t N w) / R        torque as in motor.h, dry friction over `standstill` as tanh(w / standstill)
//
// Rate control of a drive motor:   V = k_t N w_commanded + k_p e + V_i,  V_i' = k_i e + (V_clipped - V) T_c,
// e = w_commanded - w Control of a steering motor:     V = k_p (a_commanded - a) - k_d a'
//
// The gains put both poles of the joint with that inertia at kControl_rad_s, or the slower one where the back
// EMF damps more, but never feed a rate forward. T_c is that too.
class MotorControl {
 public:
  static constexpr double kControl_rad_s = 8.0;

  // inertia: of what turns about the joint, armature included, and of the load that it moves.
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
