#include "sim/dynamic/wheel_contact.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/smooth_step.h"
#include "sim/rover/multipass.h"
#include "sim/soil/soil_in_force.h"
#include "sim/wheel/entry_angle.h"

namespace slipway::sim {
namespace {

using Eigen::Vector3d;

constexpr double kMaxPointOffset_radii = 0.6;  // from the wheel's middle along its travel
constexpr double kBlend_radii = 0.05;          // of depths over which points blend
constexpr double kMinTransportShare = 0.01;    // of the wheel's speed over the ground
constexpr double kBlended_standstills = 12.0;  // beyond these tanh is 1 to within 1e-10
constexpr double kDraggedRatio = 100.0;        // of speed to the rim's; the shear is mobilised far below it
constexpr double kSlidesBack = 0.25;  // ratio of backward to rim speed from which the contact is all behind
constexpr int kRutSamples = 4;        // across a wheel
constexpr double kMinRelaxation_radii = 0.2;

void add_forces(double direction, double weight, const WheelForces& forces, ContactState& contact) {
  contact.drawbar_pull_n += weight * direction * forces.drawbar_pull_n;
  contact.lateral_n += weight * forces.lateral_n;
  contact.load_n += weight * forces.vertical_n;
  contact.torque_nm += weight * direction * forces.torque_nm;
}

}  // namespace

WheelContacts::WheelContacts(const RoverModel& rover, double gravity_m_s2, int points,
                             double standstill_rad_s)
    : rover_(rover),
      gravity_m_s2_(gravity_m_s2),
      points_(points),
      standstill_rad_s_(standstill_rad_s),
      places_(rover.wheels.size()) {
  for (std::size_t k = 0; k < places_.size(); ++k) {
    places_[k].geometry = rover.wheels[k].geometry();
    places_[k].locked = rover.wheels[k].drive == WheelDrive::kLocked;
  }
}

void WheelContacts::set_soil(std::size_t k, const Soil& soil, double rim_speed_m_s) {
  Place& place = places_[k];
  place.soil = soil_in_force(soil, gravity_m_s2_, rim_speed_m_s, 0.0);
  place.numbers = numbers_of(place.geometry, place.soil, 0.0, {});
  place.rebound_share = rut_share(soil.multipass_stiffening, soil.pressure.n);
  place.remembers = remembers_tracks(soil);
  const double load = rover_.mass_kg * gravity_m_s2_ / static_cast<double>(places_.size());
  const double r = place.geometry.radius_m;
  // A soil that cannot carry the wheel at rest gets the maximum entry angle of the laws.
  const double theta =
      balanced_entry_angle_rad(place.geometry, place.soil, load, {}).value_or(kMaxEntryAngleRad);
  const double z = sinkage_m(r, theta), dz = 1e-3 * z;
  const double deeper = wheel_forces(place.geometry, place.soil, entry_angle_rad(r, z - dz), {}).vertical_n;
  const double stiffness = std::max(load - deeper, 1e-3 * load) / dz;
  const double mass = load / gravity_m_s2_;
  place.relaxation_m = std::max(theta, kMinRelaxation_radii) * r;
  place.normal_damping_s_m = 2.0 * kNormalDamping * std::sqrt(mass * stiffness) / load;
  const double slipping = wheel_forces(place.geometry, place.soil, theta, {.forward = 0.95}).drawbar_pull_n;
  const double rolling = wheel_forces(place.geometry, place.soil, theta, {}).drawbar_pull_n;
  const double shear = std::max(slipping - rolling, 1e-3 * load) / (0.05 * place.relaxation_m);
  place.tangential_damping_ns_m = 2.0 * kTangentialDamping * std::sqrt(mass * shear);
}

bool WheelContacts::find_ground(const Ground& ground, const RutMap& ruts, std::size_t k,
                                const WheelKinematics& at, ContactState& contact) const {
  const Place& place = places_[k];
  const double r = place.geometry.radius_m;
  const Eigen::Vector2d along = Eigen::Vector2d(at.axle.y(), -at.axle.x()).normalized();
  std::array<double, 9> depth;
  std::array<Vector3d, 9> normal;
  double deepest = -std::numeric_limits<double>::infinity();
  for (int i = 0; i < points_; ++i) {
    const double offset = points_ == 1 ? 0.0 : kMaxPointOffset_radii * r * (2.0 * i / (points_ - 1.0) - 1.0);
    const double x = at.centre.x() + offset * along.x(), y = at.centre.y() + offset * along.y();
    const std::optional<GroundPoint> point = ground.at(x, y);
    if (!point) return false;
    normal[i] = point->normal;
    depth[i] = r - (at.centre - Vector3d(x, y, point->height_m)).dot(point->normal);
    deepest = std::max(deepest, depth[i]);
  }
  double sum = 0.0;
  Vector3d mean = Vector3d::Zero();
  for (int i = 0; i < points_; ++i) {
    const double weight = std::exp((depth[i] - deepest) / (kBlend_radii * r));
    sum += weight;
    mean += weight * normal[i];
  }
  contact.normal = points_ == 1 ? mean : mean.normalized();
  contact.depth_m = deepest + kBlend_radii * r * std::log(sum / points_);
  if (place.remembers) find_rut(ruts, k, at, contact);
  if (rover_.wheel_slices > 1) find_slices(ground, k, at, contact);
  return true;
}

void WheelContacts::find_rut(const RutMap& ruts, std::size_t k, const WheelKinematics& at,
                             ContactState& contact) const {
  double depth = 0.0;
  contact.driven_on = 0.0;
  for (int s = 0; s < kRutSamples; ++s) {
    const Vector3d p = at.centre + slice_offset_m(places_[k].geometry.width_m, s, kRutSamples) * at.axle;
    const RutMap::Rut rut = ruts.at(p.x(), p.y());
    depth += rut.depth_m / kRutSamples;
    contact.driven_on += rut.share / kRutSamples;
  }
  contact.rut_m = places_[k].rebound_share * depth;
  contact.depth_m -= contact.rut_m;
}

// The wheel is as deep as its deepest slice, so that there is no depth at which the others jump.
void WheelContacts::find_slices(const Ground& ground, std::size_t k, const WheelKinematics& at,
                                ContactState& contact) const {
  const WheelModel& wheel = rover_.wheels[k];
  double highest = -wheel.radius_m;
  for (int s = 0; s < rover_.wheel_slices; ++s) {
    const Vector3d p = at.centre + slice_offset_m(wheel.width_m, s, rover_.wheel_slices) * at.axle;
    const std::optional<GroundPoint> point = ground.at(p.x(), p.y());
    const double middle = contact.depth_m + contact.rut_m - wheel.radius_m;
    // A slice off the map has no contact.
    contact.slice_height_m[s] =
        point ? (point->height_m - p.z()) * contact.normal.z() - middle : -wheel.radius_m;
    highest = std::max(highest, contact.slice_height_m[s]);
  }
  for (int s = 0; s < rover_.wheel_slices; ++s) contact.slice_height_m[s] -= highest;
  contact.depth_m += highest;
}

std::size_t WheelContacts::add_trials(std::size_t k, const WheelKinematics& at, const ContactState& contact,
                                      Trial* trials, WheelNumbers* numbers) const {
  const Place& place = places_[k];
  WheelNumbers one = place.numbers;
  one.theta_f = contact.entry_angle_rad;
  one.leftward = -at.slip_y;
  put_in_track(place.numbers, track_factors(place.soil, contact.driven_on), one);
  const double turning = place.locked ? kBlended_standstills * place.commanded_direction
                         : at.braked  ? at.halted_turning
                                      : at.rate_rad_s / standstill_rad_s_;
  const double ahead = turning >= kBlended_standstills    ? 1.0
                       : turning <= -kBlended_standstills ? 0.0
                                                          : 0.5 + 0.5 * std::tanh(turning);
  std::size_t count = 0;
  for (const double direction : {1.0, -1.0}) {
    const double weight = direction > 0.0 ? ahead : 1.0 - ahead;
    if (weight == 0.0) continue;
    const double forward = 1.0 - direction * at.slip_x;
    const double back = smooth_step(-forward / kSlidesBack);
    if (back < 1.0) {
      one.forward = forward;
      numbers[count] = one;
      trials[count++] = {k, direction, weight * (1.0 - back)};
    }
    if (back > 0.0) {
      one.forward = kDraggedRatio;
      numbers[count] = one;
      trials[count++] = {k, -direction, weight * back};
    }
  }
  return count;
}

void WheelContacts::add_sliced(const Trial& trial, const WheelNumbers& numbers, const WheelKinematics& at,
                               ContactState& contact) const {
  const Place& place = places_[trial.wheel];
  Soil soil = place.soil;
  put_in_track(soil, contact.driven_on);
  const SlicedWheelForces sliced = sliced_wheel_forces(
      place.geometry, soil, {contact.slice_height_m.data(), static_cast<std::size_t>(rover_.wheel_slices)},
      contact.depth_m, {numbers.forward, numbers.leftward});
  add_forces(trial.direction, trial.weight, sliced.total, contact);
  contact.moment += trial.weight * sliced.overturning_nm * at.axle.cross(contact.normal).normalized();
}

bool WheelContacts::find(const Ground& ground, const RutMap& ruts, const PerWheel<WheelKinematics>& wheels,
                         PerWheel<ContactState>& contacts) const {
  std::array<WheelNumbers, kMaxTrials> numbers;
  std::array<Trial, kMaxTrials> trials;
  std::size_t count = 0;
  for (std::size_t k = 0; k < wheels.size(); ++k) {
    ContactState& contact = contacts[k];
    contact = {};
    if (!find_ground(ground, ruts, k, wheels[k], contact)) return false;
    if (contact.depth_m <= 0.0) continue;
    const double r = places_[k].geometry.radius_m;
    contact.entry_angle_rad = std::min(entry_angle_rad(r, std::min(contact.depth_m, r)), kMaxEntryAngleRad);
    count += add_trials(k, wheels[k], contact, &trials[count], &numbers[count]);
    const double rolls = places_[k].locked            ? places_[k].commanded_direction
                         : wheels[k].rate_rad_s < 0.0 ? -1.0
                                                      : 1.0;
    contact.motion = {1.0 - rolls * wheels[k].slip_x, -wheels[k].slip_y};
  }
  if (rover_.wheel_slices > 1) {
    for (std::size_t n = 0; n < count; ++n)
      add_sliced(trials[n], numbers[n], wheels[trials[n].wheel], contacts[trials[n].wheel]);
  } else {
    std::array<WheelForces, kMaxTrials> forces;
    wheel_forces({numbers.data(), count}, {forces.data(), count});
    for (std::size_t n = 0; n < count; ++n)
      add_forces(trials[n].direction, trials[n].weight, forces[n], contacts[trials[n].wheel]);
  }
  for (std::size_t k = 0; k < wheels.size(); ++k) finish(k, wheels[k], contacts[k]);
  return true;
}

// Adds the rates of the slip states and the dampings, and turns the forces into frame M.
void WheelContacts::finish(std::size_t k, const WheelKinematics& at, ContactState& contact) const {
  const Place& place = places_[k];
  const Vector3d x = at.axle.cross(contact.normal).normalized();
  const Vector3d y = contact.normal.cross(x);
  const double v_x = at.velocity.dot(x), v_y = at.velocity.dot(y);
  const double rim = place.geometry.radius_m * at.rate_rad_s;
  const double transport = std::max(std::abs(rim), kMinTransportShare * std::hypot(v_x, v_y));
  const bool touches = contact.depth_m > 0.0;
  contact.slip_x_rate = ((touches ? rim - v_x : 0.0) - transport * at.slip_x) / place.relaxation_m;
  contact.slip_y_rate = ((touches ? -v_y : 0.0) - transport * at.slip_y) / place.relaxation_m;
  if (!touches) return;
  const double sinking = -at.velocity.dot(contact.normal);
  // Damping grows with the load and is full where the wheel carries its share of the weight.
  const double share = std::clamp(
      contact.load_n * static_cast<double>(places_.size()) / (rover_.mass_kg * gravity_m_s2_), 0.0, 1.0);
  const double damping = share * place.tangential_damping_ns_m * place.relaxation_m;
  const double along = damping * contact.slip_x_rate;
  contact.load_n *= std::max(0.0, 1.0 + place.normal_damping_s_m * sinking);
  contact.drawbar_pull_n += along;
  contact.lateral_n += damping * contact.slip_y_rate;
  contact.torque_nm += along * place.geometry.radius_m;
  contact.force = contact.drawbar_pull_n * x + contact.lateral_n * y + contact.load_n * contact.normal;
  contact.moment -= contact.torque_nm * at.axle;
  contact.moment +=
      contact.lateral_n * place.geometry.radius_m * x;  // the side force acts at the lowest point
}

}  // namespace slipway::sim
