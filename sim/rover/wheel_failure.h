#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "sim/rover/drive_command.h"
#include "sim/rover/rover_model.h"

namespace slipway::sim {

// How a wheel's drive can fail.
enum class WheelFailure {
  kLocked,  // it does not turn any more
  kFree,    // uncoupled from its gear: it turns as the ground turns it
  kOff,     // motor without power, its circuit open: the ground turns gear and motor too
};

// "locked", "free", "off".
std::string_view describe(WheelFailure failure);
// In the order of WheelFailure.
const std::vector<std::string_view>& wheel_failure_names();

// Torque at the wheel that turns gear and unpowered motor, by their dry friction alone:
//
//   T = I_0 k_t N / eta + T_g      (symbols and the other equation, of DriveMotor::currents_by_format:
//   motor.h)
double unpowered_drag_nm(const DriveMotor& drive);

// The rover with that failure of a wheel; its other wheels stay. The motor's friction is that at the drive's
// temperature. Throws std::out_of_range where there is no such wheel.
void fail_wheel(RoverModel& rover, std::size_t wheel, WheelFailure failure,
                const DriveConditions& conditions = {});

// By the wheels' names; those that the rover does not have are passed over.
using FailedWheels = std::map<std::string, WheelFailure, std::less<>>;
void fail_wheels(RoverModel& rover, const FailedWheels& failed, const DriveConditions& conditions = {});

}  // namespace slipway::sim
