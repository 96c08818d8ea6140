#include "sim/quasi_static/rover_balance.h"

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>

#include "core/pose.h"
#include "sim/rover/multipass.h"
#include "sim/soil/soil_in_force.h"
#include "sim/wheel/entry_angle.h"
#include "sim/wheel/free_wheel.h"

namespace slipway::sim {
namespace {

// A wheel that does not turn is treated as one that turns at this share of the fastest wheel's rate, since
// its slip would be infinite otherwise. All shear is mobilised at much lower slip.
constexpr double kMinRateRatio = 1e-3;
// The speed scale where no wheel is commanded to turn and the rover not to move; any scale serves then.
constexpr double kMinSpeedScale_m_s = 1e-9;

double half_wheelbase(const RoverModel& rover) {
  double front = rover.wheels.front().position_m.x(), rear = front;
  for (const WheelModel& wheel : rover.wheels) {
    front = std::max(front, wheel.position_m.x());
    rear = std::min(rear, wheel.position_m.x());
  }
  return 0.5 * (front - rear);
}

// A force at p and a moment, in frame B.
struct Wrench {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();  // about the point where the force acts
};

using WheelLoads = Eigen::Matrix<double, 5, 1>;

WheelLoads loads_of(const RoverBalance::WheelContact& contact) {
  const WheelForces& f = contact.forces;
  return {f.drawbar_pull_n, f.lateral_n, f.vertical_n, f.torque_nm, contact.overturning_nm};
}

}  // namespace

RoverBalance::RoverBalance(const RoverModel& rover, double gravity_m_s2, const Stance& stance,
                           const PerWheel<Soil>& soils, const DriveCommand& command)
    : rover_(rover),
      stance_(stance),
      soils_(soils),
      places_(rover.wheels.size()),
      contacts_(rover.wheels.size()),
      in_air_(rover.wheels.size(), false),
      joints_(joint_count(rover.suspension.type)),
      undetermined_(undetermined_loads(rover)),
      in_contact_(static_cast<int>(rover.wheels.size())),
      travel_(travel_direction(command)),
      weight_(rover.mass_kg * gravity_m_s2),
      length_(half_wheelbase(rover)) {
  const PerWheel<WheelCommand> commanded = wheel_commands(rover, command);
  double fastest = kMinSpeedScale_m_s;
  for (int k = 0; k < wheel_count(); ++k)
    fastest = std::max(fastest, std::abs(commanded[k].rate_rad_s) * rover.wheels[k].radius_m);
  // Wheels that cannot roll in their commanded direction (a crab without steering) are dragged at that speed.
  if (fastest <= kMinSpeedScale_m_s && !command.turn_in_place)
    fastest = std::max(fastest, std::abs(command.speed_m_s));
  speed_scale_ = fastest;
  set_soils(gravity_m_s2, command, commanded);
  for (int k = 0; k < wheel_count(); ++k) {
    place_wheel(k, commanded[k]);
    place_slices(k);
  }
  set_gravity();
  if (undetermined_ == 0) return;
  set_gap_gradient();
  set_compatibility();
}

void RoverBalance::set_soils(double gravity_m_s2, const DriveCommand& command,
                             const PerWheel<WheelCommand>& commanded) {
  leaders_ = leaders(rover_, command);
  rut_shares_ = PerWheel<double>(soils_.size());
  for (std::size_t k = 0; k < soils_.size(); ++k) {
    const bool in_a_track = leaders_[k] >= 0;
    if (in_a_track) rut_shares_[k] = rut_share(soils_[k].multipass_stiffening, soils_[k].pressure.n);
    const double rim_speed = std::abs(commanded[k].rate_rad_s) * rover_.wheels[k].radius_m;
    soils_[k] = soil_in_force(soils_[k], gravity_m_s2, rim_speed, in_a_track);
  }
}

// The body's weight acts at the rocker pivots, and the differential passes equal moments to both sides. On
// the joints therefore acts only the wheels' own weight.
void RoverBalance::set_gravity() {
  Attitude truth = stance_.attitude;
  truth.roll_rad += rover_.roll_bias_rad;
  truth.pitch_rad += rover_.pitch_bias_rad;
  const bool biased = rover_.roll_bias_rad != 0.0 || rover_.pitch_bias_rad != 0.0;
  const Eigen::Matrix3d R_MB = biased ? rotation_MB(truth) : stance_.R_MB;
  const Eigen::Vector3d g = -R_MB.row(2).transpose();  // per unit of weight, frame B
  gravity_ = Vector::Zero(equilibrium_count());
  gravity_[0] = travel_.x() * g.x() + travel_.y() * g.y();
  gravity_[1] = travel_.x() * g.y() - travel_.y() * g.x();
  gravity_[2] = g.z();
  gravity_.segment<3>(3) = rover_.com_m.cross(g) / length_;
  const double own = rover_.wheel_weight * rover_.wheel_mass_kg() / rover_.mass_kg;
  if (own == 0.0) return;
  for (int j = 0; j < joints_; ++j)
    for (int k = 0; k < wheel_count(); ++k)
      gravity_[6 + j] += own * g.dot(joint_motion(rover_, stance_, k, j).shift) / length_;
}

void RoverBalance::place_wheel(int k, const WheelCommand& commanded) {
  const WheelModel& wheel = rover_.wheels[k];
  const Eigen::Vector3d& normal = stance_.normal_B[k];
  WheelPlace& place = places_[k];
  place.geometry = wheel.geometry();
  place.numbers = numbers_of(place.geometry, soils_[k], 0.0, {});
  place.motion = true_motion(wheel, commanded);
  place.direction = commanded.rate_rad_s < 0.0 ? -1.0 : 1.0;
  const double steer = place.motion.steer_rad;
  const Eigen::Vector3d heading(std::cos(steer), std::sin(steer), 0.0);
  const Eigen::Vector3d axle(-std::sin(steer), std::cos(steer), 0.0);
  const Eigen::Vector3d x = axle.cross(normal).normalized();
  const Eigen::Vector3d y = normal.cross(x);
  const Eigen::Vector3d& p = stance_.p_B_wheel[k];
  std::array<JointMotion, kMaxJoints> joint;
  for (int j = 0; j < joints_; ++j) joint[j] = joint_motion(rover_, stance_, k, j);

  // The columns are for drawbar pull, lateral and vertical force, torque, and overturning moment. The pull
  // and the torque of a wheel that turns backwards point backwards. The lateral force acts at the rim's
  // lowest point.
  const std::array<Wrench, 5> unit{
      Wrench{.force = place.direction * x,
             .moment = -rover_.pull_below_axle * wheel.radius_m * place.direction * y},
      Wrench{.force = y, .moment = wheel.radius_m * x}, Wrench{.force = normal},
      Wrench{.moment = -(1.0 - rover_.pull_below_axle) * place.direction * y}, Wrench{.moment = x}};
  place.effect.resize(equilibrium_count(), 5);
  for (int column = 0; column < 5; ++column) {
    const Wrench& w = unit[column];
    auto e = place.effect.col(column);
    e[0] = travel_.x() * w.force.x() + travel_.y() * w.force.y();
    e[1] = travel_.x() * w.force.y() - travel_.y() * w.force.x();
    e[2] = w.force.z();
    e.segment<3>(3) = (p.cross(w.force) + w.moment) / length_;
    for (int j = 0; j < joints_; ++j)
      e[6 + j] = (w.force.dot(joint[j].shift) + w.moment.y() * joint[j].turn) / length_;
  }
  place.effect /= weight_;

  // On sloping ground under one wheel the rim travels along its tangent while the body keeps its own speed.
  // A free wheel's motion is given per speed scale at first; its rim speed is found together with its forces.
  const double rim_speed =
      wheel.drive == WheelDrive::kFree
          ? speed_scale_
          : std::max(std::abs(place.motion.rate_rad_s) * wheel.radius_m, kMinRateRatio * speed_scale_);
  const double along = place.direction * speed_scale_ / (rim_speed * std::max(0.2, x.dot(heading)));
  const double across = speed_scale_ / (rim_speed * std::max(0.2, y.dot(axle)));
  const Eigen::Vector3d d(travel_.x(), travel_.y(), 0.0), e(-travel_.y(), travel_.x(), 0.0);
  const Eigen::Vector3d turning = Eigen::Vector3d::UnitZ().cross(p) / length_;
  place.forward_ratio << along * heading.dot(d), along * heading.dot(e), along * heading.dot(turning);
  place.leftward_ratio << across * axle.dot(d), across * axle.dot(e), across * axle.dot(turning);
}

bool RoverBalance::is_sliced(int k) const {
  return !stance_.slice_height_m.empty() && rover_.wheels[k].drive != WheelDrive::kFree;
}

void RoverBalance::place_slices(int k) {
  if (!is_sliced(k)) return;
  WheelPlace& place = places_[k];
  const SliceHeights& height = stance_.slice_height_m[k];
  place.highest_m = *std::max_element(height.begin(), height.begin() + rover_.wheel_slices);
  for (int s = 0; s < rover_.wheel_slices; ++s) place.slice_height_m[s] = height[s] - place.highest_m;
}

bool RoverBalance::any_driven() const {
  for (int k = 0; k < wheel_count(); ++k)
    if (rover_.wheels[k].drive == WheelDrive::kDriven && places_[k].motion.rate_rad_s != 0.0) return true;
  return false;
}

bool RoverBalance::all_driven() const {
  return std::all_of(rover_.wheels.begin(), rover_.wheels.end(),
                     [](const WheelModel& wheel) { return wheel.drive == WheelDrive::kDriven; });
}

WheelMotion RoverBalance::motion_of(int k, const Vector& unknowns) const {
  const auto motion = unknowns.head<kMotions>();
  return {.forward = places_[k].forward_ratio.dot(motion), .leftward = places_[k].leftward_ratio.dot(motion)};
}

RoverBalance::WheelContact RoverBalance::free_contact(const Trial& trial) const {
  const WheelPlace& place = places_[trial.wheel];
  const WheelModel& wheel = rover_.wheels[trial.wheel];
  const FreeRolling rolling = roll_freely(place.geometry, soils_[trial.wheel], trial.entry_angle_rad,
                                          trial.motion, wheel.drag_nm, kMinRateRatio);
  const bool stands = rolling.rim_ratio <= kMinRateRatio;
  return {rolling.forces, rolling.motion,
          stands ? 0.0 : place.direction * rolling.rim_ratio * speed_scale_ / wheel.radius_m, 0.0};
}

RoverBalance::WheelContact RoverBalance::sliced_contact(const Trial& trial) const {
  const WheelPlace& place = places_[trial.wheel];
  const SlicedWheelForces sliced =
      sliced_wheel_forces(place.geometry, soils_[trial.wheel],
                          {place.slice_height_m.data(), static_cast<std::size_t>(rover_.wheel_slices)},
                          sinkage_m(place.geometry.radius_m, trial.entry_angle_rad), trial.motion);
  return {sliced.total, trial.motion, place.motion.rate_rad_s, sliced.overturning_nm};
}

void RoverBalance::contacts_of(std::span<const Trial> trials, std::span<WheelContact> contacts) const {
  std::array<WheelNumbers, kMaxTrials> numbers;
  std::array<WheelForces, kMaxTrials> forces;
  std::array<std::size_t, kMaxTrials> of;
  std::size_t count = 0;
  for (std::size_t t = 0; t < trials.size(); ++t) {
    const Trial& trial = trials[t];
    if (rover_.wheels[trial.wheel].drive == WheelDrive::kFree) {
      contacts[t] = free_contact(trial);
      continue;
    }
    if (is_sliced(trial.wheel)) {
      contacts[t] = sliced_contact(trial);
      continue;
    }
    const WheelPlace& place = places_[trial.wheel];
    numbers[count] = place.numbers;
    numbers[count].theta_f = trial.entry_angle_rad;
    numbers[count].forward = trial.motion.forward;
    numbers[count].leftward = trial.motion.leftward;
    of[count++] = t;
    contacts[t] = {{}, trial.motion, place.motion.rate_rad_s, 0.0};
  }
  wheel_forces({numbers.data(), count}, {forces.data(), count});
  for (std::size_t n = 0; n < count; ++n) contacts[of[n]].forces = forces[n];
}

void RoverBalance::find_contacts(const Vector& unknowns) {
  std::array<Trial, kMaxWheels> trials;
  std::array<WheelContact, kMaxWheels> found;
  std::size_t count = 0;
  for (int k = 0; k < wheel_count(); ++k) {
    const WheelMotion motion = motion_of(k, unknowns);
    if (in_air_[k]) {
      const bool turns = rover_.wheels[k].drive == WheelDrive::kDriven;
      contacts_[k] = {{}, motion, turns ? places_[k].motion.rate_rad_s : 0.0, 0.0};
    } else {
      trials[count++] = {k, unknowns[kMotions + k], motion};
    }
  }
  contacts_of({trials.data(), count}, {found.data(), count});
  for (std::size_t n = 0; n < count; ++n) contacts_[trials[n].wheel] = found[n];
}

const RoverBalance::Vector& RoverBalance::residual(const Vector& unknowns) {
  if (at_.size() == unknowns.size() && at_ == unknowns) return residual_at_;
  find_contacts(unknowns);
  at_ = unknowns;
  const int top = equilibrium_count();
  Vector& sum = residual_at_;
  sum.resize(kMotions + wheel_count());
  sum.head(top) = gravity_;
  Loads own(wheel_count());
  for (int k = 0; k < wheel_count(); ++k) {
    if (in_air_[k]) continue;
    sum.head(top).noalias() += places_[k].effect * loads_of(contacts_[k]);
    if (undetermined_ > 0) own[k] = sinkage_m(places_[k].geometry.radius_m, unknowns[kMotions + k]);
  }
  if (undetermined_ == 0) return sum;
  int row = top + undetermined_;
  for (int k = 0; k < wheel_count(); ++k) {
    if (!in_air_[k]) continue;
    own[k] = 0.0;
    sum[--row] = unknowns[kMotions + k] - kMinEntryAngleRad;
  }
  sum.segment(top, row - top) = compatibility_ * own + compatibility_of_gap_;
  return sum;
}

RoverBalance::Matrix RoverBalance::jacobian(const Vector& unknowns) const {
  const int top = equilibrium_count(), size = kMotions + wheel_count();
  Matrix jacobian = Matrix::Zero(size, size);
  constexpr double kStep = 1e-7;
  std::array<Trial, kMaxTrials> trials;
  std::array<WheelContact, kMaxTrials> moved;
  std::size_t count = 0;
  for (int k = 0; k < wheel_count(); ++k) {
    if (in_air_[k]) continue;
    const WheelMotion m = motion_of(k, unknowns);
    const double theta = unknowns[kMotions + k];
    trials[count++] = {k, theta + kStep, m};
    trials[count++] = {k, theta, {m.forward + kStep, m.leftward}};
    trials[count++] = {k, theta, {m.forward, m.leftward + kStep}};
  }
  contacts_of({trials.data(), count}, {moved.data(), count});
  for (std::size_t n = 0; n < count; n += 3) {
    const int k = trials[n].wheel;
    const auto slope = [&](std::size_t of) -> WheelLoads {
      return (loads_of(moved[of]) - loads_of(contacts_[k])) / kStep;
    };
    const WheelPlace& place = places_[k];
    jacobian.col(kMotions + k).head(top).noalias() = place.effect * slope(n);
    jacobian.topLeftCorner(top, kMotions) +=
        place.effect * (slope(n + 1) * place.forward_ratio + slope(n + 2) * place.leftward_ratio);
  }
  if (undetermined_ == 0) return jacobian;
  int row = top + undetermined_;
  for (int k = 0; k < wheel_count(); ++k)
    if (in_air_[k]) jacobian(--row, kMotions + k) = 1.0;
  for (int k = 0; k < wheel_count(); ++k) {
    if (in_air_[k]) continue;
    const double sinkage_rate = places_[k].geometry.radius_m * std::sin(unknowns[kMotions + k]);
    jacobian.col(kMotions + k).segment(top, row - top) = compatibility_.col(k) * sinkage_rate;
  }
  return jacobian;
}

}  // namespace slipway::sim
