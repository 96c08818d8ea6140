#pragma once

#include <optional>

namespace slipway::sim {

// A drive motor behind its gear, as a rover file gives it. Every wheel has the same.
struct DriveMotor {
  double torque_constant_nm_per_a = 0.0224;
  double gear_ratio = 1500.0;
  double gear_efficiency = 0.55;
  double no_load_current_a = 0.06;
  double damping_nms_rad = 0.0;  // of the motor's shaft: b in ROAMS section 2.4
  double max_wheel_rate_rad_s = 0.4;
  double bus_voltage_v = 28.0;
  std::optional<double> resistance_ohm;
  std::optional<double> max_current_a;  // a wheel that needs more is stalled

  // Friction of the gearbox at the wheel, besides what the efficiency and the no-load current hold (effect
  // gearbox_friction).
  double gear_friction_nm = 0.0;
  double gear_viscous_nms_rad = 0.0;  // at the wheel
  // Its currents are those that drive-campaign/1 defines: gear_efficiency divides a torque of either sign. A
  // wheel that the ground drives then gives back more than it got.
  bool currents_by_format = false;
  double rotor_inertia_kg_m2 = 4e-7;  // of the motor's shaft, before the gear; read by the dynamic level

  // Change per kelvin above the reference temperature (effect motor_temperature): the torque constant falls
  // by its share, the winding's resistance rises, all friction falls as lubricant thins.
  double reference_temp_c = 20.0;
  double torque_constant_per_k = 0.0;
  double resistance_per_k = 0.0;
  double friction_per_k = 0.0;

  // Read where a drive is followed through the day, see planner/timing/motor_warmth.h: from motor and gear to
  // the air, the time constant with which they follow it, and between what they may be.
  std::optional<double> thermal_resistance_k_w = {}, thermal_time_constant_s = {};
  std::optional<double> min_temp_c = {}, max_temp_c = {};

  bool operator==(const DriveMotor&) const = default;
};

// The motor's own numbers at a temperature. Each is kept above a tenth of its value at the reference.
DriveMotor at_temperature(const DriveMotor& drive, double motor_temp_c);

// A drive motor in steady motion: no inductance, Kirchhoff's law [ROAMS section 2.4; drive-campaign format].
//
//   T' = T + T_g sign(w) + B w                               torque at the gear's output, N m
//   I = T' / (k_t N eta) + b N w / k_t + I_0 sign(w)         current, A, where the motor drives: T' w >= 0
//   I = T' eta / (k_t N) + b N w / k_t + I_0 sign(w)         where the ground does: T' w < 0
//   V = R I + k_t N w                                        terminal voltage, V (R = 0 where none is given)
//
//   T    torque at the wheel, N m        w    rate of the wheel, rad/s        k_t  torque constant, N m/A
//   N    gear ratio    eta  gear efficiency    I_0  no-load current, A        b    damping at the shaft
//   T_g, B  friction and viscous friction of the gearbox, at the wheel
//
// The gear loses the same share either way, so that |V I| never exceeds |T w| where the ground drives. The
// drives of docs/validation.md's Cuadriga gave back nothing within the error. Properties: continuous in the
// torque, and rising with it.
struct MotorState {
  double current_a = 0.0;
  double voltage_v = 0.0;
  double electric_power_w = 0.0;  // drawn from the bus; a wheel that is driven by the ground returns nothing
};

MotorState motor_state(const DriveMotor& drive, double torque_nm, double wheel_rate_rad_s);

// The inverse: the torque at the wheel that a current at a rate means. Dry friction and the gear's other
// efficiency come in over `standstill_rad_s` as tanh(w / standstill) where that is above 0, for motions
// through rest, where the gear passes a torque as if the motor drove.
double torque_of_current_nm(const DriveMotor& drive, double current_a, double wheel_rate_rad_s,
                            double standstill_rad_s = 0.0);

// True where the torque needs more current or voltage than there is.
bool stalls(const DriveMotor& drive, const MotorState& state);

// The winding's resistance, ohm; where none is given the one that lets twenty times the no-load current, and
// 10 A at least, flow at the greatest rate, and lets a tenth of the bus voltage drop at least: the dynamic
// level needs one, and it must not stall a motor that the other levels know no limit of.
double winding_resistance_ohm(const DriveMotor& drive);

// The greatest torque at standstill that bus voltage and current limit allow; infinite where neither the
// resistance nor a limit is given.
double stall_torque_nm(const DriveMotor& drive);

// The fastest rate that the bus voltage allows against a driving torque, 0 where the torque stalls the motor;
// never above max_wheel_rate_rad_s.
double attainable_rate_rad_s(const DriveMotor& drive, double torque_nm);

}  // namespace slipway::sim
