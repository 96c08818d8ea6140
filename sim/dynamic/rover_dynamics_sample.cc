// What can be read from a state of the rover in motion: pose, attitude, clearance, and a whole sample.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/angle.h"
#include "sim/dynamic/rover_dynamics.h"
#include "sim/wheel/slip_ratio.h"

namespace slipway::sim {
namespace {

using Eigen::Vector3d;

double yaw_of(const Eigen::Matrix3d& R) {
  return std::atan2(R(1, 0), R(0, 0));
}

}  // namespace

Pose2 RoverDynamics::pose(const double* y) const {
  const Eigen::Matrix3d R = Eigen::Quaterniond(y[3], y[4], y[5], y[6]).normalized().toRotationMatrix();
  return {origin_M_.x() + y[0], origin_M_.y() + y[1], yaw_rad_ + wrapped_rad(yaw_of(R) - yaw_rad_)};
}

double RoverDynamics::tilt_rad(const double* y) const {
  const Eigen::Matrix3d R = Eigen::Quaterniond(y[3], y[4], y[5], y[6]).normalized().toRotationMatrix();
  return std::acos(std::clamp(R(2, 2), -1.0, 1.0));
}

BellyClearance RoverDynamics::belly(const double* y) const {
  const Eigen::Matrix3d R = Eigen::Quaterniond(y[3], y[4], y[5], y[6]).normalized().toRotationMatrix();
  return belly_clearance(rover_, ground_, origin_M_ + Vector3d(y[0], y[1], y[2]), R);
}

double RoverDynamics::speed_m_s(const double* y) const {
  return Vector3d(y[twist_at_ + 3], y[twist_at_ + 4], y[twist_at_ + 5]).norm();
}

PerWheel<double> RoverDynamics::steered_rad(const double* y) const {
  PerWheel<double> steered(rover_.wheels.size());
  for (std::size_t k = 0; k < steered.size(); ++k)
    if (bodies_.steering[k] >= 0)
      steered[k] = y[angle_state_[bodies_.steering[k]]] - rover_.wheels[k].steering_offset_rad;
  return steered;
}

LegPlace RoverDynamics::place(const double* y) const {
  if (!driver_) return {};
  const Pose2 now = pose(y);
  return place_on_leg(driver_->leg(), leg_start_, now, now.yaw_rad - leg_start_.yaw_rad);
}

DriveSample RoverDynamics::sample(double t, const double* y) {
  std::vector<double> rate(size_);
  DriveSample out;
  derivative(t, y, rate.data());
  out.time_s = t;
  out.p_MB = p_MB_;
  out.attitude = attitude_of(R_MB_);
  out.attitude.yaw_rad = pose(y).yaw_rad;
  out.angular_rate_B = {y[twist_at_], y[twist_at_ + 1], y[twist_at_ + 2]};
  out.velocity_B = {y[twist_at_ + 3], y[twist_at_ + 4], y[twist_at_ + 5]};
  out.specific_force_B = base_rate_.tail<3>() + out.angular_rate_B.cross(out.velocity_B) -
                         R_MB_.transpose() * Vector3d(0.0, 0.0, -gravity_m_s2_);
  for (int s = 0; s < 2; ++s) {
    if (bodies_.rocker[s] >= 0) out.rocker_rad[s] = angles_[bodies_.rocker[s]];
    if (bodies_.bogie[s] >= 0) out.bogie_rad[s] = angles_[bodies_.bogie[s]];
  }
  const std::size_t count = rover_.wheels.size();
  out.wheels = PerWheel<WheelState>(count);
  out.steer_rad = out.commanded_rate_rad_s = out.voltage_v = PerWheel<double>(count);
  out.turned_rad = turned_rad_;
  for (std::size_t k = 0; k < count; ++k) {
    const ContactState& contact = contact_[k];
    WheelState& wheel = out.wheels[k];
    wheel.rate_rad_s = kinematics_[k].rate_rad_s;
    wheel.in_air = contact.depth_m <= 0.0;
    wheel.current_a = drive_[k].motor.current_a;
    wheel.load_n = contact.load_n;
    wheel.entry_angle_rad = contact.entry_angle_rad;
    wheel.sinkage_m = std::max(0.0, contact.depth_m) + contact.rut_m;
    wheel.drawbar_pull_n = contact.drawbar_pull_n;
    wheel.lateral_force_n = contact.lateral_n;
    wheel.torque_nm = contact.torque_nm;
    wheel.slip_ratio = bounded_slip(slip_from_speed_ratio(contact.motion.forward));
    wheel.slip_angle_rad = std::atan2(contact.motion.leftward, contact.motion.forward);
    if (bodies_.steering[k] >= 0) out.steer_rad[k] = angles_[bodies_.steering[k]];
    if (rover_.wheels[k].drive == WheelDrive::kDriven) out.commanded_rate_rad_s[k] = commanded_[k].rate_rad_s;
    out.voltage_v[k] = drive_[k].motor.terminal_v;
    out.turned_rad[k] += 0.5 * (wheel.rate_rad_s + last_rate_rad_s_[k]) * (t - last_t_);
  }
  if (const std::optional<double> slip = slip_ratio(t, y)) {
    out.slip_ratio = *slip;
    out.driving = true;
  }
  return out;
}

std::optional<double> RoverDynamics::slip_ratio(double t, const double* y) const {
  if (!driver_ || driver_->rate_share(t) <= 0.5) return std::nullopt;
  const DriveCommand& command = driver_->leg().command;
  const double commanded = driver_->rate_share(t) * attainable_share(rover_, command) *
                           (command.turn_in_place ? command.turn_rate_rad_s : command.speed_m_s);
  const Eigen::Vector2d velocity_B(y[twist_at_ + 3], y[twist_at_ + 4]);
  const double done = command.turn_in_place ? y[twist_at_ + 2] : travel_direction(command).dot(velocity_B);
  return bounded_slip(slip_from_speed_ratio(done / commanded));
}

double RoverDynamics::mechanical_energy_j(const double* y) {
  unpack(y);
  const Vector3d com = p_MB_ + R_MB_ * dynamics_.com_B();
  return dynamics_.kinetic_energy_j() + bodies_.tree.mass_kg() * gravity_m_s2_ * com.z();
}

}  // namespace slipway::sim
