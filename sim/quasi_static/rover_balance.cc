#include "sim/quasi_static/rover_balance.h"

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/pose.h"
#include "sim/wheel/entry_angle.h"
#include "sim/wheel/free_wheel.h"

namespace slipway::sim {
namespace {

RoverBalance::WheelLoads loads_of(const RoverBalance::WheelContact& contact) {
  const WheelForces& f = contact.forces;
  return {f.drawbar_pull_n, f.lateral_n, f.vertical_n, f.torque_nm, contact.overturning_nm};
}

}  // namespace

RoverBalance::RoverBalance(const RoverModel& rover, double gravity_m_s2, const Stance& stance,
                           const PerWheel<Soil>& soils, const DriveCommand& command,
                           const OutsideWrench* outside)
    : own_geometry_(std::in_place, rover, gravity_m_s2, stance, command), geometry_(*own_geometry_) {
  if (outside != nullptr) own_geometry_->add(*outside);
  set_soils(soils);
}

RoverBalance::RoverBalance(const BalanceGeometry& geometry, const PerWheel<Soil>& soils)
    : geometry_(geometry) {
  set_soils(soils);
}

void RoverBalance::set_soils(const PerWheel<Soil>& soils) {
  const std::size_t count = geometry_.wheels.size();
  for (std::size_t k = 0; k < count; ++k) {
    const Soil& soil = soils_.emplace_back(
        soil_in_force(soils[k], geometry_.gravity_m_s2, geometry_.wheels[k].commanded_rim_speed_m_s, 0.0));
    numbers_.push_back(numbers_of(geometry_.wheels[k].geometry, soil, 0.0, {}));
    const double stiffening = soil.multipass_stiffening;
    rut_shares_.push_back(stiffening > 0.0 ? rut_share(stiffening, soil.pressure.n) : 0.0);
    follows_tracks_ |= remembers_tracks(soil) && !geometry_.command.turn_in_place;
  }
  if (follows_tracks_) fresh_ = numbers_;
  contacts_.resize(count);
  in_air_.resize(count, false);
  share_in_track_.resize(count);
  in_contact_ = wheel_count();
  tracks_.setZero(wheel_count(), wheel_count());
  if (geometry_.undetermined == 0) return;
  set_sinkage_scale();
  set_compatibility();
}

TrackShares RoverBalance::tracks_in(const Vector& unknowns) const {
  const Eigen::Vector2d d = geometry_.travel, e(-d.y(), d.x());
  return tracks_followed(rover(), unknowns[0] * d + unknowns[1] * e,
                         unknowns[2] / geometry_.half_wheelbase_m);
}

void RoverBalance::follow_tracks(const Vector& unknowns) {
  if (follows_tracks_ && !holds_tracks_) set_tracks(tracks_in(unknowns));
}

void RoverBalance::hold_tracks(const Vector& unknowns, double way) {
  holds_tracks_ = true;
  at_.resize(0);
  const TrackShares there = tracks_in(unknowns);
  if (held_tracks_.size() == 0) held_tracks_ = there;
  held_tracks_ += way * (there - held_tracks_);
  set_tracks(held_tracks_);
}

void RoverBalance::release_tracks() {
  holds_tracks_ = false;
  at_.resize(0);
}

void RoverBalance::set_tracks(const TrackShares& tracks) {
  tracks_ = tracks;
  for (int k = 0; k < wheel_count(); ++k) {
    share_in_track_[k] = tracks_.row(k).sum();
    put_in_track(fresh_[k], track_factors(soils_[k], share_in_track_[k]), numbers_[k]);
  }
  if (geometry_.undetermined > 0) set_compatibility_of_sinkages();
}

Soil RoverBalance::soil_under(const Trial& trial) const {
  Soil soil = soils_[trial.wheel];
  put_in_track(soil, trial.share_in_track);
  return soil;
}

bool RoverBalance::any_driven() const {
  for (int k = 0; k < wheel_count(); ++k)
    if (rover().wheels[k].drive == WheelDrive::kDriven && place(k).motion.rate_rad_s != 0.0) return true;
  return false;
}

bool RoverBalance::all_driven() const {
  return std::all_of(rover().wheels.begin(), rover().wheels.end(),
                     [](const WheelModel& wheel) { return wheel.drive == WheelDrive::kDriven; });
}

WheelMotion RoverBalance::motion_of(int k, const Vector& unknowns) const {
  const auto motion = unknowns.head<kMotions>();
  return {.forward = place(k).forward_ratio.dot(motion), .leftward = place(k).leftward_ratio.dot(motion)};
}

RoverBalance::WheelContact RoverBalance::free_contact(const Trial& trial) const {
  const BalanceGeometry::Wheel& at = place(trial.wheel);
  const WheelModel& wheel = rover().wheels[trial.wheel];
  const FreeRolling rolling = roll_freely(at.geometry, soil_under(trial), trial.entry_angle_rad, trial.motion,
                                          wheel.drag_nm, BalanceGeometry::kMinRateRatio);
  const bool stands = rolling.rim_ratio <= BalanceGeometry::kMinRateRatio;
  return {rolling.forces, rolling.motion,
          stands ? 0.0 : at.direction * rolling.rim_ratio * geometry_.speed_scale_m_s / wheel.radius_m, 0.0};
}

RoverBalance::WheelContact RoverBalance::sliced_contact(const Trial& trial) const {
  const BalanceGeometry::Wheel& at = place(trial.wheel);
  const SlicedWheelForces sliced =
      sliced_wheel_forces(at.geometry, soil_under(trial),
                          {at.slice_height_m.data(), static_cast<std::size_t>(rover().wheel_slices)},
                          sinkage_m(at.geometry.radius_m, trial.entry_angle_rad), trial.motion);
  return {sliced.total, trial.motion, at.motion.rate_rad_s, sliced.overturning_nm};
}

// Every wheel presses on the ground and needs nothing but the kernel.
bool RoverBalance::all_in_kernel() const {
  return all_in_contact() && std::none_of(geometry_.wheels.begin(), geometry_.wheels.end(),
                                          [](const auto& wheel) { return wheel.is_free || wheel.is_sliced; });
}

void RoverBalance::contacts_of(std::span<const Trial> trials, std::span<WheelContact> contacts) const {
  std::array<WheelNumbers, kMaxTrials> numbers;
  std::array<WheelForces, kMaxTrials> forces;
  std::array<std::size_t, kMaxTrials> of;
  std::size_t count = 0;
  for (std::size_t t = 0; t < trials.size(); ++t) {
    const Trial& trial = trials[t];
    const BalanceGeometry::Wheel& at = place(trial.wheel);
    if (at.is_free) {
      contacts[t] = free_contact(trial);
      continue;
    }
    if (at.is_sliced) {
      contacts[t] = sliced_contact(trial);
      continue;
    }
    numbers[count] = numbers_[trial.wheel];
    numbers[count].theta_f = trial.entry_angle_rad;
    numbers[count].forward = trial.motion.forward;
    numbers[count].leftward = trial.motion.leftward;
    if (follows_tracks_)
      put_in_track(fresh_[trial.wheel], track_factors(soils_[trial.wheel], trial.share_in_track),
                   numbers[count]);
    of[count++] = t;
    contacts[t] = {{}, trial.motion, at.motion.rate_rad_s, 0.0};
  }
  wheel_forces({numbers.data(), count}, {forces.data(), count});
  for (std::size_t n = 0; n < count; ++n) contacts[of[n]].forces = forces[n];
}

// Without a copy of the wheels' numbers.
void RoverBalance::find_contacts_in_kernel(const Vector& unknowns) {
  std::array<WheelForces, kMaxWheels> forces;
  const std::size_t count = soils_.size();
  for (int k = 0; k < wheel_count(); ++k) {
    const WheelMotion motion = motion_of(k, unknowns);
    numbers_[k].theta_f = unknowns[kMotions + k];
    numbers_[k].forward = motion.forward;
    numbers_[k].leftward = motion.leftward;
    contacts_[k] = {{}, motion, place(k).motion.rate_rad_s, 0.0};
  }
  wheel_forces({numbers_.data(), count}, {forces.data(), count});
  for (std::size_t k = 0; k < count; ++k) contacts_[k].forces = forces[k];
}

void RoverBalance::find_contacts(const Vector& unknowns) {
  if (all_in_kernel()) return find_contacts_in_kernel(unknowns);
  std::array<Trial, kMaxWheels> trials;
  std::array<WheelContact, kMaxWheels> found;
  std::size_t count = 0;
  for (int k = 0; k < wheel_count(); ++k) {
    const WheelMotion motion = motion_of(k, unknowns);
    if (in_air_[k]) {
      const bool turns = rover().wheels[k].drive == WheelDrive::kDriven;
      contacts_[k] = {{}, motion, turns ? place(k).motion.rate_rad_s : 0.0, 0.0};
    } else {
      trials[count++] = {k, unknowns[kMotions + k], motion, share_in_track_[k]};
    }
  }
  contacts_of({trials.data(), count}, {found.data(), count});
  for (std::size_t n = 0; n < count; ++n) contacts_[trials[n].wheel] = found[n];
}

const RoverBalance::Vector& RoverBalance::residual(const Vector& unknowns) {
  if (at_.size() == unknowns.size() && at_ == unknowns) return residual_at_;
  follow_tracks(unknowns);
  find_contacts(unknowns);
  at_ = unknowns;
  const int top = equilibrium_count();
  Vector& all = residual_at_;
  all.resize(kMotions + wheel_count());
  BalanceGeometry::Equilibrium sum = geometry_.gravity;
  Loads own(wheel_count());
  for (int k = 0; k < wheel_count(); ++k) {
    if (in_air_[k]) continue;
    sum.noalias() += place(k).effect * loads_of(contacts_[k]);
    if (geometry_.undetermined > 0) own[k] = sinkage_m(place(k).geometry.radius_m, unknowns[kMotions + k]);
  }
  all.head(top) = sum.head(top);
  if (geometry_.undetermined == 0) return all;
  int row = top + geometry_.undetermined;
  for (int k = 0; k < wheel_count(); ++k) {
    if (!in_air_[k]) continue;
    own[k] = 0.0;
    all[--row] = unknowns[kMotions + k] - kMinEntryAngleRad;
  }
  all.segment(top, row - top) = compatibility_ * own + compatibility_of_gap_;
  return all;
}

PerWheel<RoverBalance::WheelPoint> RoverBalance::points(const Vector& unknowns) const {
  PerWheel<WheelPoint> points(soils_.size());
  for (int k = 0; k < wheel_count(); ++k) {
    const WheelMotion m = motion_of(k, unknowns);
    points[k] = {loads_of(contacts_[k]), {unknowns[kMotions + k], m.forward, m.leftward}, share_in_track_[k]};
  }
  return points;
}

RoverBalance::WheelSlopes RoverBalance::slopes(const Vector& unknowns) const {
  constexpr double kStep = 1e-7;
  std::array<Trial, kMaxTrials> trials;
  std::array<WheelContact, kMaxTrials> moved;
  std::size_t count = 0;
  for (int k = 0; k < wheel_count(); ++k) {
    if (in_air_[k]) continue;
    const WheelMotion m = motion_of(k, unknowns);
    const double theta = unknowns[kMotions + k], share = share_in_track_[k];
    trials[count++] = {k, theta + kStep, m, share};
    trials[count++] = {k, theta, {m.forward + kStep, m.leftward}, share};
    trials[count++] = {k, theta, {m.forward, m.leftward + kStep}, share};
    if (follows_tracks_) trials[count++] = {k, theta, m, share + kStep};
  }
  contacts_of({trials.data(), count}, {moved.data(), count});
  WheelSlopes slopes{PerWheel<WheelSlope>(soils_.size(), WheelSlope::Zero()),
                     PerWheel<WheelLoads>(soils_.size(), WheelLoads::Zero()), PerWheel<double>(soils_.size()),
                     PerWheel<double>(soils_.size())};
  const std::size_t of_each = follows_tracks_ ? 4 : 3;
  for (std::size_t n = 0; n < count; n += of_each) {
    const int k = trials[n].wheel;
    const WheelLoads here = loads_of(contacts_[k]);
    for (int by = 0; by < 3; ++by)
      slopes.of[k].col(by) = (loads_of(moved[n + static_cast<std::size_t>(by)]) - here) / kStep;
    if (follows_tracks_) slopes.by_share[k] = (loads_of(moved[n + 3]) - here) / kStep;
    slopes.vertical_n[k] = contacts_[k].forces.vertical_n;
    slopes.entry_angle_rad[k] = unknowns[kMotions + k];
  }
  return slopes;
}

RoverBalance::WheelSlopes RoverBalance::carried_over(const WheelSlopes& from, const Vector& unknowns) const {
  constexpr double kMaxRatio = 10.0;  // beyond it the slopes are left as they are
  WheelSlopes slopes = from;
  for (int k = 0; k < wheel_count(); ++k) {
    const double ratio = contacts_[k].forces.vertical_n / from.vertical_n[k];
    if (!(ratio > 1.0 / kMaxRatio && ratio < kMaxRatio)) continue;
    slopes.of[k] *= ratio;
    slopes.by_share[k] *= ratio;
    slopes.of[k].col(0) *= from.entry_angle_rad[k] / unknowns[kMotions + k];
  }
  return slopes;
}

void RoverBalance::correct(const PerWheel<WheelPoint>& before, const Vector& unknowns,
                           WheelSlopes& slopes) const {
  constexpr double kMinSquare = 1e-24;  // of a step that tells of slopes
  const PerWheel<WheelPoint> now = points(unknowns);
  for (std::size_t k = 0; k < now.size(); ++k) {
    slopes.vertical_n[k] = contacts_[k].forces.vertical_n;
    slopes.entry_angle_rad[k] = now[k].arguments[0];
    const Eigen::Vector3d step = now[k].arguments - before[k].arguments;
    const double square = step.squaredNorm();
    if (square < kMinSquare) continue;
    const WheelLoads missed = now[k].loads - before[k].loads - slopes.of[k] * step -
                              slopes.by_share[k] * (now[k].share_in_track - before[k].share_in_track);
    slopes.of[k] += missed * (step / square).transpose();
  }
}

void RoverBalance::move_along(const WheelSlopes& slopes, const Vector& unknowns) {
  const PerWheel<double> share_before = share_in_track_;
  follow_tracks(unknowns);
  for (int k = 0; k < wheel_count(); ++k) {
    WheelContact& contact = contacts_[k];
    const WheelMotion from = motion_of(k, at_), motion = motion_of(k, unknowns);
    const Eigen::Vector3d step(unknowns[kMotions + k] - at_[kMotions + k], motion.forward - from.forward,
                               motion.leftward - from.leftward);
    const WheelLoads loads =
        loads_of(contact) + slopes.of[k] * step + slopes.by_share[k] * (share_in_track_[k] - share_before[k]);
    contact.forces = {
        .drawbar_pull_n = loads[0], .lateral_n = loads[1], .vertical_n = loads[2], .torque_nm = loads[3]};
    contact.overturning_nm = loads[4];
    if (!place(k).is_free) contact.motion = motion;
  }
  at_ = unknowns;
  residual_at_.setZero();
}

// What the motion changes of the wheels' shares in tracks, by one-sided differences: of the wheels' loads,
// which is returned, and of their depths, which goes into the rows of compatibility.
RoverBalance::Motions RoverBalance::slopes_by_tracks(const Vector& unknowns, const WheelSlopes& slopes,
                                                     Matrix& jacobian) const {
  constexpr double kStep = 1e-7;
  Motions by_motions = Motions::Zero();
  PerWheel<double> depth;
  if (geometry_.undetermined > 0) depth = total_sinkages_m(unknowns);
  for (int motion = 0; motion < kMotions; ++motion) {
    Vector moved = unknowns;
    moved[motion] += kStep;
    const TrackShares tracks = tracks_in(moved);
    const Loads share_slope = (tracks - tracks_).rowwise().sum() / kStep;
    for (int k = 0; k < wheel_count(); ++k)
      if (!in_air_[k])
        by_motions.col(motion).noalias() += place(k).effect * slopes.by_share[k] * share_slope[k];
    if (geometry_.undetermined == 0) continue;
    const PerWheel<double> there = total_sinkages_m(unknowns, tracks);
    auto rows = jacobian.col(motion).segment(equilibrium_count(), compatibility_of_depth_.rows());
    for (int k = 0; k < wheel_count(); ++k)
      rows += compatibility_of_depth_.col(k) * ((there[k] - depth[k]) / kStep);
  }
  return by_motions;
}

RoverBalance::Matrix RoverBalance::jacobian(const Vector& unknowns, const WheelSlopes& slopes) const {
  const int top = equilibrium_count(), size = kMotions + wheel_count();
  Matrix jacobian = Matrix::Zero(size, size);
  Motions by_motions = Motions::Zero();
  for (int k = 0; k < wheel_count(); ++k) {
    if (in_air_[k]) continue;
    const BalanceGeometry::Wheel& at = place(k);
    const Motions by = at.effect * slopes.of[k];
    jacobian.col(kMotions + k).head(top) = by.col(0).head(top);
    by_motions += by.col(1) * at.forward_ratio + by.col(2) * at.leftward_ratio;
  }
  if (follows_tracks_ && !holds_tracks_) by_motions += slopes_by_tracks(unknowns, slopes, jacobian);
  jacobian.topLeftCorner(top, kMotions) = by_motions.topRows(top);
  if (geometry_.undetermined == 0) return jacobian;
  int row = top + geometry_.undetermined;
  for (int k = 0; k < wheel_count(); ++k)
    if (in_air_[k]) jacobian(--row, kMotions + k) = 1.0;
  for (int k = 0; k < wheel_count(); ++k) {
    if (in_air_[k]) continue;
    const double sinkage_rate = place(k).geometry.radius_m * std::sin(unknowns[kMotions + k]);
    jacobian.col(kMotions + k).segment(top, row - top) = compatibility_.col(k) * sinkage_rate;
  }
  return jacobian;
}

}  // namespace slipway::sim
