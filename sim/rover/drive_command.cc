#include "sim/rover/drive_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <vector>

#include "core/angle.h"

namespace slipway::sim {
namespace {

// Velocity of a wheel's place on the rover that moves as commanded, frame B.
Eigen::Vector2d commanded_velocity(const WheelModel& wheel, const DriveCommand& command) {
  const double yaw_rate =
      command.turn_in_place ? command.turn_rate_rad_s : command.speed_m_s * command.curvature_1_m;
  const double speed = command.turn_in_place ? 0.0 : command.speed_m_s;
  const Eigen::Vector2d turning(-yaw_rate * wheel.position_m.y(), yaw_rate * wheel.position_m.x());
  return speed * travel_direction(command) + turning;
}

WheelCommand commanded_wheel(const WheelModel& wheel, const DriveCommand& command) {
  const Eigen::Vector2d velocity = commanded_velocity(wheel, command);
  const double radius = wheel.reckoned_radius_m();
  if (!wheel.steerable || velocity.norm() == 0.0)
    return {.steer_rad = 0.0, .rate_rad_s = velocity.x() / radius};
  // A wheel points within a quarter turn of straight ahead and rolls backwards rather than turning further.
  const double sign = velocity.x() < 0.0 || (velocity.x() == 0.0 && velocity.y() < 0.0) ? -1.0 : 1.0;
  return {.steer_rad = std::atan2(sign * velocity.y(), sign * velocity.x()),
          .rate_rad_s = sign * velocity.norm() / radius};
}

}  // namespace

Eigen::Vector2d travel_direction(const DriveCommand& command) {
  if (command.turn_in_place) return Eigen::Vector2d::UnitX();
  return {std::cos(command.crab_rad), std::sin(command.crab_rad)};
}

double attainable_share(const RoverModel& rover, const DriveCommand& command) {
  double fastest = 0.0;
  for (const WheelModel& wheel : rover.wheels)
    fastest = std::max(fastest, std::abs(commanded_wheel(wheel, command).rate_rad_s));
  return fastest > rover.drive.max_wheel_rate_rad_s ? rover.drive.max_wheel_rate_rad_s / fastest : 1.0;
}

PerWheel<WheelCommand> wheel_commands(const RoverModel& rover, const DriveCommand& command) {
  PerWheel<WheelCommand> commanded(rover.wheels.size());
  const double share = attainable_share(rover, command);
  for (std::size_t k = 0; k < commanded.size(); ++k) {
    commanded[k] = commanded_wheel(rover.wheels[k], command);
    commanded[k].rate_rad_s *= share;
  }
  return commanded;
}

std::optional<std::string> why_no_crab(const RoverModel& rover, double crab_rad) {
  std::vector<std::string_view> straight;
  for (const WheelModel& wheel : rover.wheels)
    if (!wheel.steerable) straight.push_back(wheel.name);
  if (crab_rad == 0.0 || straight.size() < rover.wheels.size()) return std::nullopt;
  return fmt::format("crab_deg = {:g}, must be 0: the wheels of {} don't steer ({})", deg_from_rad(crab_rad),
                     rover.name, fmt::join(straight, ", "));
}

WheelCommand true_motion(const WheelModel& wheel, const WheelCommand& commanded) {
  WheelCommand motion = commanded;
  motion.steer_rad += wheel.steering_offset_rad;
  if (wheel.drive == WheelDrive::kLocked) motion.rate_rad_s = 0.0;
  if (wheel.drive == WheelDrive::kDriven) motion.rate_rad_s *= wheel.rate_share;
  return motion;
}

}  // namespace slipway::sim
