#include "sim/motor.h"

#include <algorithm>
#include <cmath>

namespace slipway::sim {

MotorState motor_state(const DriveMotor& drive, double torque_nm, double wheel_rate_rad_s) {
  const double geared = drive.torque_constant_nm_per_a * drive.gear_ratio;
  const double sign = wheel_rate_rad_s > 0.0 ? 1.0 : wheel_rate_rad_s < 0.0 ? -1.0 : 0.0;
  MotorState state;
  state.current_a = torque_nm / (geared * drive.gear_efficiency) + drive.no_load_current_a * sign;
  state.voltage_v = drive.resistance_ohm.value_or(0.0) * state.current_a + geared * wheel_rate_rad_s;
  state.electric_power_w = std::max(0.0, state.voltage_v * state.current_a);
  return state;
}

bool stalls(const DriveMotor& drive, const MotorState& state) {
  return (drive.max_current_a && std::abs(state.current_a) > *drive.max_current_a) ||
         std::abs(state.voltage_v) > drive.bus_voltage_v;
}

}  // namespace slipway::sim
