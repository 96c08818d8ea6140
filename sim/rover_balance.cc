#include "sim/rover_balance.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace slipway::sim {
namespace {

// A wheel told to stand still still slips against the ground: as a wheel turning this slowly against the
// fastest one.
constexpr double kSlowestRateRatio = 1e-3;

double half_wheelbase(const RoverModel& rover) {
  double front = rover.wheels.front().position_m.x(), rear = front;
  for (const WheelModel& wheel : rover.wheels) {
    front = std::max(front, wheel.position_m.x());
    rear = std::min(rear, wheel.position_m.x());
  }
  return 0.5 * (front - rear);
}

// Force f at p and moment m (frame B) as entries of the nine equations, undivided.
struct Wrench {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();  // about the point where the force acts
};

}  // namespace

RoverBalance::RoverBalance(const RoverModel& rover, double gravity_m_s2, const Stance& stance,
                           const std::array<Soil, kWheels>& soils, const DriveCommand& command)
    : rover_(rover),
      stance_(stance),
      soils_(soils),
      told_(wheel_commands(rover, command)),
      weight_(rover.mass_kg * gravity_m_s2),
      length_(half_wheelbase(rover)) {
  double fastest = 0.0;
  for (int k = 0; k < kWheels; ++k)
    fastest = std::max(fastest, std::abs(told_[k].rate_rad_s) * rover.wheels[k].radius_m);
  speed_scale_ = fastest;
  for (int k = 0; k < kWheels; ++k) place_wheel(k);
  const Eigen::Vector3d g = -stance_.R_MB.row(2).transpose();  // per unit of weight, frame B
  // The body hangs on both rocker pivots through the differential, which passes equal moments to both sides:
  // gravity has no entry in the equations of bogies and differential.
  gravity_.setZero();
  gravity_.head<3>() = g;
  gravity_.segment<3>(3) = rover_.com_m.cross(g) / length_;
}

void RoverBalance::place_wheel(int k) {
  const WheelModel& wheel = rover_.wheels[k];
  const Eigen::Vector3d& normal = stance_.normal_B[k];
  const double steer = told_[k].steer_rad;
  const Eigen::Vector3d heading(std::cos(steer), std::sin(steer), 0.0);
  const Eigen::Vector3d axle(-std::sin(steer), std::cos(steer), 0.0);
  const Eigen::Vector3d x = axle.cross(normal).normalized();
  const Eigen::Vector3d y = normal.cross(x);
  const double direction = told_[k].rate_rad_s < 0.0 ? -1.0 : 1.0;

  const bool left = wheel.side == Side::kLeft;
  const Eigen::Vector3d& p = stance_.p_B_wheel[k];
  Eigen::Vector3d rocker = rover_.suspension.rocker_pivot_m;
  if (!left) rocker.y() = -rocker.y();
  const Eigen::Vector3d& bogie = left ? stance_.p_B_left_bogie : stance_.p_B_right_bogie;

  // Columns: drawbar pull, lateral, vertical, torque. A wheel that turns backwards pulls and is driven
  // backwards.
  const std::array<Wrench, 4> unit{Wrench{.force = direction * x}, Wrench{.force = y},
                                   Wrench{.force = normal}, Wrench{.moment = -direction * y}};
  WheelPlace& place = places_[k];
  for (int column = 0; column < 4; ++column) {
    const Wrench& w = unit[column];
    auto e = place.effect.col(column);
    e.head<3>() = w.force;
    e.segment<3>(3) = (p.cross(w.force) + w.moment) / length_;
    const double about_bogie = ((p - bogie).cross(w.force) + w.moment).y() / length_;
    e[6] = wheel.on_bogie && left ? about_bogie : 0.0;
    e[7] = wheel.on_bogie && !left ? about_bogie : 0.0;
    e[8] = (left ? 1.0 : -1.0) * ((p - rocker).cross(w.force) + w.moment).y() / length_;
  }
  place.effect /= weight_;

  // On sloping ground under one wheel the rim travels along its tangent while the body keeps its own speed.
  const double rim_speed =
      std::max(std::abs(told_[k].rate_rad_s) * wheel.radius_m, kSlowestRateRatio * speed_scale_);
  const double along = direction * speed_scale_ / (rim_speed * std::max(0.2, x.dot(heading)));
  const double across = speed_scale_ / (rim_speed * std::max(0.2, y.dot(axle)));
  const Eigen::Vector3d turning = Eigen::Vector3d::UnitZ().cross(p) / length_;
  place.forward_ratio << along * heading.x(), along * heading.y(), along * heading.dot(turning);
  place.leftward_ratio << across * axle.x(), across * axle.y(), across * axle.dot(turning);
}

WheelMotion RoverBalance::motion_of(int k, const Vector& unknowns) const {
  const auto motion = unknowns.head<kMotions>();
  return {.forward = places_[k].forward_ratio.dot(motion), .leftward = places_[k].leftward_ratio.dot(motion)};
}

RoverBalance::Vector RoverBalance::residual(const Vector& unknowns) {
  Vector sum = gravity_;
  for (int k = 0; k < kWheels; ++k) {
    const WheelGeometry wheel{rover_.wheels[k].radius_m, rover_.wheels[k].width_m};
    const WheelForces& f = forces_[k] =
        wheel_forces(wheel, soils_[k], unknowns[kMotions + k], motion_of(k, unknowns));
    sum += places_[k].effect * Eigen::Vector4d(f.drawbar_pull_n, f.lateral_n, f.vertical_n, f.torque_nm);
  }
  return sum;
}

RoverBalance::Matrix RoverBalance::jacobian(const Vector& unknowns) const {
  Matrix jacobian = Matrix::Zero();
  constexpr double kStep = 1e-7;
  for (int k = 0; k < kWheels; ++k) {
    const WheelGeometry wheel{rover_.wheels[k].radius_m, rover_.wheels[k].width_m};
    const WheelMotion motion = motion_of(k, unknowns);
    const double theta = unknowns[kMotions + k];
    const auto slope = [&](double angle, const WheelMotion& moved) -> Vector {
      const WheelForces d = wheel_forces(wheel, soils_[k], angle, moved) - forces_[k];
      return places_[k].effect *
             (Eigen::Vector4d(d.drawbar_pull_n, d.lateral_n, d.vertical_n, d.torque_nm) / kStep);
    };
    jacobian.col(kMotions + k) = slope(theta + kStep, motion);
    jacobian.leftCols<kMotions>() +=
        slope(theta, {motion.forward + kStep, motion.leftward}) * places_[k].forward_ratio +
        slope(theta, {motion.forward, motion.leftward + kStep}) * places_[k].leftward_ratio;
  }
  return jacobian;
}

Eigen::Matrix<double, kWheels, 1> RoverBalance::resting_loads_n() const {
  // Vertical force, roll, pitch, bogies and differential are the six equations that loads alone can balance.
  constexpr std::array<int, kWheels> rows{2, 3, 4, 6, 7, 8};
  Eigen::Matrix<double, kWheels, kWheels> a;
  Eigen::Matrix<double, kWheels, 1> b;
  for (int i = 0; i < kWheels; ++i) {
    for (int k = 0; k < kWheels; ++k) a(i, k) = places_[k].effect(rows[i], 2);
    b[i] = -gravity_[rows[i]];
  }
  return a.partialPivLu().solve(b);
}

}  // namespace slipway::sim
