#include "sim/dynamic/rover_multibody.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "core/angle.h"

namespace slipway::sim {
namespace {

using Eigen::Vector3d;

constexpr double kRockerShare = 0.03, kBogieShare = 0.02;

Vector3d on_side(const Vector3d& left, Side side) {
  return {left.x(), side == Side::kLeft ? left.y() : -left.y(), left.z()};
}

// The mass properties of equal point masses, with a small inertia added so that points in a line are valid
// too.
MassProperties of_points(double mass_kg, const std::vector<Vector3d>& points) {
  MassProperties mass{.mass_kg = mass_kg};
  for (const Vector3d& p : points) mass.com_m += p / static_cast<double>(points.size());
  mass.inertia_kg_m2 = 1e-3 * mass_kg * Eigen::Matrix3d::Identity();
  for (const Vector3d& p : points) {
    const Vector3d d = p - mass.com_m;
    mass.inertia_kg_m2 += mass_kg / static_cast<double>(points.size()) *
                          (d.squaredNorm() * Eigen::Matrix3d::Identity() - d * d.transpose());
  }
  return mass;
}

MassProperties disc(double mass_kg, const WheelModel& wheel) {
  const double r2 = wheel.radius_m * wheel.radius_m, b2 = wheel.width_m * wheel.width_m;
  const double across = mass_kg * (3.0 * r2 + b2) / 12.0;
  return {mass_kg, wheel.position_m, Vector3d(across, 0.5 * mass_kg * r2, across).asDiagonal()};
}

double armature(const DriveMotor& motor) {
  return motor.gear_ratio * motor.gear_ratio * motor.rotor_inertia_kg_m2;
}

// The suspension's bodies: rockers, then bogies, left before right.
std::vector<RevoluteBody> suspension_bodies(const RoverModel& rover, RoverMultibody& out) {
  std::vector<RevoluteBody> bodies;
  if (rover.suspension.type == SuspensionType::kRigid) return bodies;
  const bool has_bogies = rover.suspension.type == SuspensionType::kRockerBogie;
  for (const bool bogie : {false, true}) {
    if (bogie && !has_bogies) break;
    for (const Side side : {Side::kLeft, Side::kRight}) {
      const int s = side == Side::kLeft ? 0 : 1;
      RevoluteBody body;
      body.name = std::string(s == 0 ? "left " : "right ") + (bogie ? "bogie" : "rocker");
      body.parent = bogie ? out.rocker[s] : -1;
      body.pivot_m = on_side(bogie ? rover.suspension.bogie_pivot_m : rover.suspension.rocker_pivot_m, side);
      std::vector<Vector3d> points{body.pivot_m};
      if (!bogie && has_bogies) points.push_back(on_side(rover.suspension.bogie_pivot_m, side));
      for (const WheelModel& wheel : rover.wheels)
        if (wheel.side == side && (has_bogies && wheel.on_bogie) == bogie) points.push_back(wheel.position_m);
      body.mass = of_points(bogie ? rover.bogie_mass_kg() : rover.rocker_mass_kg(), points);
      (bogie ? out.bogie : out.rocker)[s] = static_cast<int>(bodies.size());
      bodies.push_back(body);
    }
  }
  return bodies;
}

int carrier_of(const RoverModel& rover, const WheelModel& wheel, const RoverMultibody& out) {
  const int s = wheel.side == Side::kLeft ? 0 : 1;
  const bool on_bogie = rover.suspension.type == SuspensionType::kRockerBogie && wheel.on_bogie;
  return on_bogie ? out.bogie[s] : out.rocker[s];
}

void add_wheels(const RoverModel& rover, std::vector<RevoluteBody>& bodies, RoverMultibody& out) {
  out.steering = out.wheel = out.carrier = PerWheel<int>(rover.wheels.size(), -1);
  for (std::size_t k = 0; k < rover.wheels.size(); ++k) {
    const WheelModel& wheel = rover.wheels[k];
    int carrier = carrier_of(rover, wheel, out);
    if (wheel.steerable) {
      RevoluteBody steering;
      steering.name = wheel.name + " steering";
      steering.parent = carrier;
      steering.pivot_m = wheel.position_m;
      steering.axis = Vector3d::UnitZ();
      steering.armature_kg_m2 = armature(rover.steering.value_or(rover.drive));
      carrier = out.steering[k] = static_cast<int>(bodies.size());
      bodies.push_back(steering);
    }
    RevoluteBody spin;
    spin.name = wheel.name;
    spin.parent = out.carrier[k] = carrier;
    spin.pivot_m = wheel.position_m;
    spin.mass = disc(rover.wheel_mass_kg(), wheel);
    spin.round = true;
    // A locked wheel is welded by an infinite armature.
    spin.armature_kg_m2 =
        wheel.drive == WheelDrive::kLocked ? std::numeric_limits<double>::infinity() : armature(rover.drive);
    out.wheel[k] = static_cast<int>(bodies.size());
    bodies.push_back(spin);
  }
}

MassProperties body_of(const RoverModel& rover, const std::vector<RevoluteBody>& bodies) {
  MassProperties body{.mass_kg = rover.body_mass_kg()};
  if (!(body.mass_kg > 0.0)) throw std::invalid_argument("rover_multibody: no mass is left for the body");
  Vector3d moment = rover.mass_kg * rover.com_m;
  for (const RevoluteBody& other : bodies) moment -= other.mass.mass_kg * other.mass.com_m;
  body.com_m = moment / body.mass_kg;
  const double l = rover.body_length_m, w = rover.body_width_m, h = rover.com_m.z();
  const Vector3d box = body.mass_kg / 12.0 * Vector3d(w * w + h * h, l * l + h * h, l * l + w * w);
  body.inertia_kg_m2 = rover.masses.body_inertia_kg_m2.value_or(box).asDiagonal();
  return body;
}

double half_wheelbase(const RoverModel& rover) {
  const auto [rear, front] = std::minmax_element(
      rover.wheels.begin(), rover.wheels.end(),
      [](const WheelModel& a, const WheelModel& b) { return a.position_m.x() < b.position_m.x(); });
  return 0.5 * (front->position_m.x() - rear->position_m.x());
}

}  // namespace

RoverMultibody rover_multibody(const RoverModel& rover) {
  RoverMultibody out{.tree = Multibody({.mass_kg = 1.0}, {})};
  std::vector<RevoluteBody> bodies = suspension_bodies(rover, out);
  add_wheels(rover, bodies, out);
  const MassProperties body = body_of(rover, bodies);
  out.tree = Multibody(body, std::move(bodies));
  // The weight is that on Earth, for which the differential is assumed to be built.
  constexpr double kEarth_m_s2 = 9.81;
  const double load_nm = 0.1 * rover.mass_kg * kEarth_m_s2 * half_wheelbase(rover);
  out.differential_stiffness_nm_rad =
      rover.suspension.differential_stiffness_nm_rad.value_or(load_nm / rad_from_deg(0.01));
  const double pitch_inertia = body.inertia_kg_m2(1, 1);
  out.differential_damping_nms_rad = rover.suspension.differential_damping_nms_rad.value_or(
      std::sqrt(0.5 * pitch_inertia * out.differential_stiffness_nm_rad));
  out.rocker_stop_rad = rover.suspension.rocker_stop_rad.value_or(out.rocker_stop_rad);
  out.bogie_stop_rad = rover.suspension.bogie_stop_rad.value_or(out.bogie_stop_rad);
  return out;
}

}  // namespace slipway::sim
