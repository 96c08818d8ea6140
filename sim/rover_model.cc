#include "sim/rover_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string_view>

namespace slipway::sim {
namespace {

constexpr std::array<std::string_view, 6> kNames{"lf", "lm", "lr", "rf", "rm", "rr"};

class FaultList {
 public:
  void require_in(std::string pointer, std::string_view key, double value, double lowest, double highest) {
    if (value >= lowest && value <= highest) return;
    faults_.push_back(
        {std::move(pointer), fmt::format("{} = {:g}, must be in [{:g}, {:g}]", key, value, lowest, highest)});
  }
  void add(std::string pointer, std::string message) {
    faults_.push_back({std::move(pointer), std::move(message)});
  }
  std::vector<Fault> take() { return std::move(faults_); }

 private:
  std::vector<Fault> faults_;
};

void check_wheels(const RoverModel& rover, FaultList& faults) {
  if (rover.wheels.size() != kNames.size()) {
    faults.add("/wheels", fmt::format("{} wheels, must be 6 (lf lm lr rf rm rr)", rover.wheels.size()));
    return;
  }
  std::array<int, 2> on_bogie{};
  for (std::size_t k = 0; k < rover.wheels.size(); ++k) {
    const WheelModel& wheel = rover.wheels[k];
    const std::string at = fmt::format("/wheels/{}", k);
    if (wheel.name != kNames[k])
      faults.add(at + "/name",
                 fmt::format("name = \"{}\", must be \"{}\" in this place", wheel.name, kNames[k]));
    faults.require_in(at + "/radius_m", "radius_m", wheel.radius_m, 0.02, 1.0);
    faults.require_in(at + "/width_m", "width_m", wheel.width_m, 0.01, 1.0);
    const bool left = wheel.side == Side::kLeft;
    if (left != (wheel.position_m.y() > 0.0))
      faults.add(at + "/position_m", "position_m[1] must be positive on the left and negative on the right");
    on_bogie[left ? 0 : 1] += wheel.on_bogie ? 1 : 0;
  }
  for (const int count : on_bogie)
    if (count != 2)
      faults.add("/suspension/bogie_wheels",
                 fmt::format("a side's bogie carries {} wheels, must be 2", count));
}

void check_mass(const RoverModel& rover, FaultList& faults) {
  faults.require_in("/mass_kg", "mass_kg", rover.mass_kg, 1.0, 5000.0);
  faults.require_in("/com_m", "com_m[2]", rover.com_m.z(), 0.01, 3.0);
  double front = -std::numeric_limits<double>::infinity(), rear = -front, half_track = 0.0;
  for (const WheelModel& wheel : rover.wheels) {
    front = std::max(front, wheel.position_m.x());
    rear = std::min(rear, wheel.position_m.x());
    half_track = std::max(half_track, std::abs(wheel.position_m.y()));
  }
  if (!(rover.com_m.x() < front && rover.com_m.x() > rear && std::abs(rover.com_m.y()) < half_track))
    faults.add("/com_m", "com_m lies outside the wheels: the rover would tip over on level ground");
}

void check_drive(const RoverModel& rover, FaultList& faults) {
  const DriveMotor& drive = rover.drive;
  faults.require_in("/drive/torque_constant_nm_per_a", "torque_constant_nm_per_a",
                    drive.torque_constant_nm_per_a, 1e-4, 10.0);
  faults.require_in("/drive/gear_ratio", "gear_ratio", drive.gear_ratio, 1.0, 1e5);
  faults.require_in("/drive/gear_efficiency", "gear_efficiency", drive.gear_efficiency, 0.05, 1.0);
  faults.require_in("/drive/no_load_current_a", "no_load_current_a", drive.no_load_current_a, 0.0, 10.0);
  faults.require_in("/drive/max_wheel_rate_deg_s", "max_wheel_rate_rad_s", drive.max_wheel_rate_rad_s, 1e-3,
                    100.0);
  faults.require_in("/drive/bus_voltage_v", "bus_voltage_v", drive.bus_voltage_v, 1.0, 400.0);
  if (drive.resistance_ohm)
    faults.require_in("/drive/resistance_ohm", "resistance_ohm", *drive.resistance_ohm, 1e-3, 1e3);
  if (drive.max_current_a)
    faults.require_in("/drive/max_current_a", "max_current_a", *drive.max_current_a, 1e-3, 1e3);
}

}  // namespace

double RoverModel::smallest_wheel_radius_m() const {
  double radius = std::numeric_limits<double>::infinity();
  for (const WheelModel& wheel : wheels) radius = std::min(radius, wheel.radius_m);
  return radius;
}

double RoverModel::track_m() const {
  double left = 0.0, right = 0.0;
  for (const WheelModel& wheel : wheels) {
    left = std::max(left, wheel.position_m.y());
    right = std::min(right, wheel.position_m.y());
  }
  return left - right;
}

std::vector<Fault> faults_of(const RoverModel& rover) {
  FaultList faults;
  check_wheels(rover, faults);
  check_mass(rover, faults);
  check_drive(rover, faults);
  faults.require_in("/belly_clearance_m", "belly_clearance_m", rover.belly_clearance_m, 0.01, 2.0);
  faults.require_in("/body_length_m", "body_length_m", rover.body_length_m, 0.1, 10.0);
  faults.require_in("/body_width_m", "body_width_m", rover.body_width_m, 0.1, 10.0);
  faults.require_in("/max_tilt_deg", "max_tilt_rad", rover.max_tilt_rad, 0.01, 1.05);
  faults.require_in("/cruise_speed_m_s", "cruise_speed_m_s", rover.cruise_speed_m_s, 1e-4, 5.0);
  faults.require_in("/turn_rate_deg_s", "turn_rate_rad_s", rover.turn_rate_rad_s, 1e-4, 2.0);
  faults.require_in("/min_turn_radius_m", "min_turn_radius_m", rover.min_turn_radius_m, 0.0, 100.0);
  return faults.take();
}

}  // namespace slipway::sim
