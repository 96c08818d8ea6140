#include "sim/rover/wheel_failure.h"

namespace slipway::sim {

const std::vector<std::string_view>& wheel_failure_names() {
  static const std::vector<std::string_view> names{"locked", "free", "off"};
  return names;
}

std::string_view describe(WheelFailure failure) {
  return wheel_failure_names()[static_cast<std::size_t>(failure)];
}

double unpowered_drag_nm(const DriveMotor& drive) {
  constexpr double kSlowly_rad_s = 1e-9;
  return -torque_of_current_nm(drive, 0.0, kSlowly_rad_s);
}

void fail_wheel(RoverModel& rover, std::size_t wheel, WheelFailure failure,
                const DriveConditions& conditions) {
  WheelModel& failed = rover.wheels.at(wheel);
  failed.drive = failure == WheelFailure::kLocked ? WheelDrive::kLocked : WheelDrive::kFree;
  if (failure != WheelFailure::kOff) return;
  const double temp_c = conditions.motor_temp_c.value_or(rover.drive.reference_temp_c);
  failed.drag_nm += unpowered_drag_nm(at_temperature(rover.drive, temp_c));
}

void fail_wheels(RoverModel& rover, const FailedWheels& failed, const DriveConditions& conditions) {
  for (std::size_t k = 0; k < rover.wheels.size(); ++k)
    if (const auto found = failed.find(rover.wheels[k].name); found != failed.end())
      fail_wheel(rover, k, found->second, conditions);
}

}  // namespace slipway::sim
