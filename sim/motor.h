#pragma once

#include "sim/rover_model.h"

namespace slipway::sim {

// A drive motor behind its gear, steady: no inductance, Kirchhoff's law [ROAMS section 2.4; drive-campaign
// format].
//
//   I = T / (k_t N eta) + I_0 sign(rate)          current, A
//   V = R I + k_t N rate                          terminal voltage, V (R = 0 where the model gives none)
//
//   T   torque at the wheel, N m      k_t torque constant, N m/A    N gear ratio    eta gear efficiency
//   I_0 no-load current, A            rate of the wheel, rad/s
struct MotorState {
  double current_a = 0.0;
  double voltage_v = 0.0;
  double electric_power_w = 0.0;  // drawn from the bus; a wheel that is driven by the ground returns nothing
};

MotorState motor_state(const DriveMotor& drive, double torque_nm, double wheel_rate_rad_s);

// True where the torque needs more current or voltage than there is.
bool stalls(const DriveMotor& drive, const MotorState& state);

}  // namespace slipway::sim
