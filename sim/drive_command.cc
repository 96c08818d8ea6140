#include "sim/drive_command.h"

#include <algorithm>
#include <cmath>

namespace slipway::sim {
namespace {

// Velocity of a wheel's place on the rover that moves as told, frame B.
Eigen::Vector2d told_velocity(const WheelModel& wheel, const DriveCommand& command) {
  const double yaw_rate =
      command.turn_in_place ? command.turn_rate_rad_s : command.speed_m_s * command.curvature_1_m;
  const double forward = command.turn_in_place ? 0.0 : command.speed_m_s;
  return {forward - yaw_rate * wheel.position_m.y(), yaw_rate * wheel.position_m.x()};
}

WheelCommand told_wheel(const WheelModel& wheel, const DriveCommand& command) {
  const Eigen::Vector2d velocity = told_velocity(wheel, command);
  if (!wheel.steerable || velocity.norm() == 0.0)
    return {.steer_rad = 0.0, .rate_rad_s = velocity.x() / wheel.radius_m};
  // A wheel points within a quarter turn of straight ahead and rolls backwards rather than turning further.
  const double sign = velocity.x() < 0.0 || (velocity.x() == 0.0 && velocity.y() < 0.0) ? -1.0 : 1.0;
  return {.steer_rad = std::atan2(sign * velocity.y(), sign * velocity.x()),
          .rate_rad_s = sign * velocity.norm() / wheel.radius_m};
}

}  // namespace

double attainable_share(const RoverModel& rover, const DriveCommand& command) {
  double fastest = 0.0;
  for (const WheelModel& wheel : rover.wheels)
    fastest = std::max(fastest, std::abs(told_wheel(wheel, command).rate_rad_s));
  return fastest > rover.drive.max_wheel_rate_rad_s ? rover.drive.max_wheel_rate_rad_s / fastest : 1.0;
}

std::array<WheelCommand, kWheels> wheel_commands(const RoverModel& rover, const DriveCommand& command) {
  std::array<WheelCommand, kWheels> told;
  const double share = attainable_share(rover, command);
  for (int k = 0; k < kWheels; ++k) {
    told[k] = told_wheel(rover.wheels[k], command);
    told[k].rate_rad_s *= share;
  }
  return told;
}

}  // namespace slipway::sim
