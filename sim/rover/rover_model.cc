#include "sim/rover/rover_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>
#include <string_view>

#include "sim/rover/rover_field.h"
#include "sim/wheel/sliced_wheel.h"

namespace slipway::sim {
namespace {

constexpr std::array<std::string_view, 6> kNames{"lf", "lm", "lr", "rf", "rm", "rr"};
constexpr std::size_t kMaxName = 8;

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
  std::vector<Fault>& all() { return faults_; }
  std::vector<Fault> take() { return std::move(faults_); }

 private:
  std::vector<Fault> faults_;
};

void check_names(const RoverModel& rover, FaultList& faults) {
  std::set<std::string_view> seen;
  for (std::size_t k = 0; k < rover.wheels.size(); ++k) {
    const std::string& name = rover.wheels[k].name;
    const std::string at = fmt::format("/wheels/{}/name", k);
    if (name.empty() || name.size() > kMaxName)
      faults.add(at, fmt::format("name = \"{}\", must have 1 to {} characters", name, kMaxName));
    if (!seen.insert(name).second) faults.add(at, fmt::format("name = \"{}\" is another wheel's", name));
  }
}

void check_wheel(const WheelModel& wheel, const std::string& at, FaultList& faults) {
  check_fields(wheel_fields(), wheel, at, faults.all());
  const double y = wheel.position_m.y();
  if (wheel.side == Side::kLeft ? !(y >= 0.0) : !(y <= 0.0))
    faults.add(at + "/position_m", "position_m[1] must be positive on the left and negative on the right");
  if (wheel.grousers) {
    faults.require_in(at + "/grousers/height_m", "height_m", wheel.grousers->height_m, 0.0, wheel.radius_m);
    faults.require_in(at + "/grousers/count", "count", wheel.grousers->count, 0.0, 500.0);
  }
  faults.require_in(at + "/drag_nm", "drag_nm", wheel.drag_nm, 0.0, 1e4);
  faults.require_in(at + "/rate_share", "rate_share", wheel.rate_share, 0.01, 1.0);
  faults.require_in(at + "/steering_offset_deg", "steering_offset_rad", wheel.steering_offset_rad, -0.8, 0.8);
  if (wheel.software_radius_m)
    faults.require_in(at + "/software_radius_m", "software_radius_m", *wheel.software_radius_m, 0.01, 2.0);
}

// False where there are too many or too few to look further.
bool check_wheels(const RoverModel& rover, FaultList& faults) {
  if (rover.wheels.size() < 3 || rover.wheels.size() > kMaxWheels) {
    faults.add("/wheels", fmt::format("{} wheels, must be 3 to {}", rover.wheels.size(), kMaxWheels));
    return false;
  }
  check_names(rover, faults);
  for (std::size_t k = 0; k < rover.wheels.size(); ++k)
    check_wheel(rover.wheels[k], fmt::format("/wheels/{}", k), faults);
  return true;
}

void check_rocker_bogie(const RoverModel& rover, FaultList& faults) {
  if (rover.wheels.size() != kNames.size()) {
    faults.add("/wheels",
               fmt::format("{} wheels, a rocker_bogie has 6 (lf lm lr rf rm rr)", rover.wheels.size()));
    return;
  }
  std::array<int, 2> on_bogie{};
  for (std::size_t k = 0; k < rover.wheels.size(); ++k) {
    const WheelModel& wheel = rover.wheels[k];
    if (wheel.name != kNames[k])
      faults.add(fmt::format("/wheels/{}/name", k),
                 fmt::format("name = \"{}\", must be \"{}\" in this place of a rocker_bogie", wheel.name,
                             kNames[k]));
    on_bogie[wheel.side == Side::kLeft ? 0 : 1] += wheel.on_bogie ? 1 : 0;
  }
  for (const int count : on_bogie)
    if (count != 2)
      faults.add("/suspension/bogie_wheels",
                 fmt::format("a side's bogie carries {} wheels, must be 2", count));
}

// A rocker on wheels in one line across the rover would turn over; a side without wheels would have to be
// carried by the other.
void check_sides(const RoverModel& rover, FaultList& faults) {
  const bool averaging = rover.suspension.type == SuspensionType::kAveraging;
  for (const Side side : {Side::kLeft, Side::kRight}) {
    const std::string_view name = side == Side::kLeft ? "left" : "right";
    double front = -std::numeric_limits<double>::infinity(), rear = -front;
    for (const WheelModel& wheel : rover.wheels) {
      if (wheel.side != side) continue;
      front = std::max(front, wheel.position_m.x());
      rear = std::min(rear, wheel.position_m.x());
    }
    if (front < rear) {
      faults.add("/wheels", fmt::format("no wheel on the {} side", name));
    } else if (averaging && !(front - rear > 0.0)) {
      faults.add(
          "/suspension/type",
          fmt::format("averaging: the {} side's rocker must carry wheels in front and behind each other",
                      name));
    }
  }
}

// Whether a point lies inside the convex hull of the wheels, seen from above: from it, no half-plane is free
// of wheels.
bool inside_wheels(const RoverModel& rover, const Eigen::Vector2d& point) {
  std::vector<double> bearing;
  for (const WheelModel& wheel : rover.wheels) {
    const Eigen::Vector2d to = wheel.position_m.head<2>() - point;
    bearing.push_back(std::atan2(to.y(), to.x()));
  }
  std::sort(bearing.begin(), bearing.end());
  double widest = bearing.front() + 2.0 * std::numbers::pi - bearing.back();
  for (std::size_t k = 1; k < bearing.size(); ++k) widest = std::max(widest, bearing[k] - bearing[k - 1]);
  return widest < std::numbers::pi - 1e-9;
}

void check_mass(const RoverModel& rover, FaultList& faults) {
  check_fields(mass_fields(), rover, "", faults.all());
  faults.require_in("/com_m", "com_m[2]", rover.com_m.z(), 0.01, 3.0);
  if (!rover.wheels.empty() && !inside_wheels(rover, rover.com_m.head<2>()))
    faults.add("/com_m", "com_m lies outside the wheels: the rover would tip over on level ground");
}

// What suspension and wheels leave for the body: its motion can't be that of no mass.
void check_masses(const RoverModel& rover, FaultList& faults) {
  constexpr double kMinBodyShare = 0.1;
  const MassDistribution& masses = rover.masses;
  check_fields(part_mass_fields(), masses, "/masses", faults.all());
  if (masses.body_inertia_kg_m2) {
    const Eigen::Vector3d& inertia = *masses.body_inertia_kg_m2;
    for (int axis = 0; axis < 3; ++axis)
      faults.require_in(fmt::format("/masses/body_inertia_kg_m2/{}", axis),
                        fmt::format("body_inertia_kg_m2[{}]", axis), inertia[axis], 1e-4, 1e5);
    // No body's moment is above the sum of the two others.
    if (2.0 * inertia.maxCoeff() > inertia.sum() * (1.0 + 1e-9))
      faults.add("/masses/body_inertia_kg_m2",
                 "body_inertia_kg_m2: one moment is above the sum of the two others, which no body has");
  }
  const double left = rover.body_mass_kg();
  if (rover.mass_kg > 0.0 && left < kMinBodyShare * rover.mass_kg)
    faults.add("/masses", fmt::format("wheels and suspension leave the body {:.4g} of {:.4g} kg, must be at "
                                      "least {:.0f} %",
                                      left, rover.mass_kg, 100.0 * kMinBodyShare));
}

}  // namespace

double RoverModel::wheel_mass_kg() const {
  constexpr double kWheelShare = 0.03;
  return masses.wheel_kg.value_or(kWheelShare * mass_kg);
}

double RoverModel::rocker_mass_kg() const {
  constexpr double kRockerShare = 0.03;
  return suspension.type == SuspensionType::kRigid ? 0.0 : masses.rocker_kg.value_or(kRockerShare * mass_kg);
}

double RoverModel::bogie_mass_kg() const {
  constexpr double kBogieShare = 0.02;
  return suspension.type == SuspensionType::kRockerBogie ? masses.bogie_kg.value_or(kBogieShare * mass_kg)
                                                         : 0.0;
}

double RoverModel::body_mass_kg() const {
  return mass_kg - static_cast<double>(wheels.size()) * wheel_mass_kg() - 2.0 * rocker_mass_kg() -
         2.0 * bogie_mass_kg();
}

double RoverModel::circumscribed_m() const {
  return 0.5 * std::hypot(body_length_m, body_width_m);
}

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
  if (check_wheels(rover, faults)) {
    if (rover.suspension.type == SuspensionType::kRockerBogie) check_rocker_bogie(rover, faults);
    check_sides(rover, faults);
  }
  faults.require_in("/wheel_slices", "wheel_slices", rover.wheel_slices, 1, kMaxSlices);
  check_mass(rover, faults);
  check_masses(rover, faults);
  check_fields(differential_fields(), rover.suspension, "/suspension", faults.all());
  check_fields(bogie_fields(), rover.suspension, "/suspension", faults.all());
  check_fields(motor_fields(), rover.drive, "/drive", faults.all());
  if (rover.drive.min_temp_c > rover.drive.max_temp_c && rover.drive.max_temp_c)
    faults.add("/drive/min_temp_c", "min_temp_c is above max_temp_c");
  const DriveMotor& drive = rover.drive;
  if (drive.thermal_resistance_k_w.has_value() != drive.thermal_time_constant_s.has_value() ||
      ((drive.min_temp_c || drive.max_temp_c) && !drive.thermal_resistance_k_w))
    faults.add("/drive",
               "a motor's temperature, and so its limits, needs both thermal_resistance_k_w and "
               "thermal_time_constant_s");
  if (rover.steering) check_fields(motor_fields(), *rover.steering, "/steering", faults.all());
  check_fields(body_fields(), rover, "", faults.all());
  faults.require_in("/roll_bias_deg", "roll_bias_rad", rover.roll_bias_rad, -0.5, 0.5);
  faults.require_in("/pitch_bias_deg", "pitch_bias_rad", rover.pitch_bias_rad, -0.5, 0.5);
  return faults.take();
}

}  // namespace slipway::sim
