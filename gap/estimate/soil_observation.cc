#include "gap/estimate/soil_observation.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/rover/motor.h"
#include "sim/soil/bekker_pressure.h"
#include "sim/soil/soil_in_force.h"
#include "sim/wheel/entry_angle.h"

namespace slipway::gap {
namespace {

struct ChannelRow {
  SoilChannel channel;
  std::string_view name, unit;
};
constexpr std::array<ChannelRow, kSoilChannels> kRows{{{SoilChannel::kTorque, "torque", "N m"},
                                                       {SoilChannel::kDrawbarPull, "drawbar_pull", "N"},
                                                       {SoilChannel::kThrust, "thrust", "N"},
                                                       {SoilChannel::kSinkage, "sinkage", "m"},
                                                       {SoilChannel::kCurrent, "current", "A"},
                                                       {SoilChannel::kPressure, "pressure", "Pa"}}};

bool same(const sim::WheelGeometry& a, const sim::WheelGeometry& b) {
  return a.radius_m == b.radius_m && a.width_m == b.width_m && a.grousers.height_m == b.grousers.height_m &&
         a.grousers.count == b.grousers.count && a.rim_friction == b.rim_friction;
}

constexpr double kMinAngle = 1e-4;
constexpr double kOfLoad = 1e-10;  // how far off the load a wheel may be left, well below a step's change

}  // namespace

std::string_view name_of(SoilChannel channel) {
  return kRows[static_cast<std::size_t>(channel)].name;
}
std::string_view unit_of(SoilChannel channel) {
  return kRows[static_cast<std::size_t>(channel)].unit;
}
std::optional<SoilChannel> soil_channel(std::string_view name) {
  for (const ChannelRow& row : kRows)
    if (row.name == name) return row.channel;
  return std::nullopt;
}

SoilObservations::SoilObservations(const SoilData& data, const ReadingNoise& noise,
                                   const std::array<bool, kSoilChannels>& used)
    : data_(data) {
  for (std::size_t i = 0; i < data.wheels.size(); ++i) add_wheel(i);
  double narrowest = std::numeric_limits<double>::infinity(), widest = 0.0;
  for (const Group& group : groups_) {
    narrowest = std::min(narrowest, group.wheel.width_m);
    widest = std::max(widest, group.wheel.width_m);
  }
  for (const PlateRecord& plate : data.plates) {
    narrowest = std::min(narrowest, plate.radius_m);
    widest = std::max(widest, plate.radius_m);
  }
  width_m_ = narrowest;
  if (!groups_.empty()) {
    width_m_ = groups_.front().wheel.width_m;
    for (const Group& group : groups_) width_m_ = std::min(width_m_, group.wheel.width_m);
  }
  one_width_ = !(widest > narrowest);
  list_readings(noise, used);
}

void SoilObservations::add_wheel(std::size_t test) {
  const WheelObservation& observation = data_.wheels[test];
  auto group = std::find_if(groups_.begin(), groups_.end(),
                            [&](const Group& g) { return same(g.wheel, observation.test.wheel); });
  if (group == groups_.end()) {
    group = groups_.emplace(groups_.end());
    group->wheel = observation.test.wheel;
  }
  place_.emplace_back(static_cast<std::size_t>(group - groups_.begin()), group->tests.size());
  group->tests.push_back(test);
  group->motions.push_back(sim::motion_of(observation.test));
  group->loads_n.push_back(observation.test.load_n);
  group->rim_speeds_m_s.push_back(sim::rim_speed_m_s(observation.test));
  group->held.push_back(observation.test.sinkage_m.has_value());
  group->sunk.push_back(false);
  group->angles.push_back(observation.test.sinkage_m ? sim::entry_angle_rad(observation.test.wheel.radius_m,
                                                                            *observation.test.sinkage_m)
                                                     : 0.3);
  group->any_thrust = group->any_thrust || observation[SoilChannel::kThrust].value.has_value();
  const std::size_t count = group->tests.size();
  group->slopes.resize(count);
  group->soils.resize(count);
  group->forces.resize(count);
  group->before.resize(count);
  group->tried.resize(count);
  group->thrusts.resize(count);
}

void SoilObservations::list_readings(const ReadingNoise& noise, const std::array<bool, kSoilChannels>& used) {
  std::array<double, kSoilChannels> squares{}, counts{};
  const auto add = [&](SoilChannel channel, std::size_t test, std::size_t sample, double value,
                       std::optional<double> std) {
    const auto c = static_cast<std::size_t>(channel);
    if (!used[c]) return;
    squares[c] += value * value;
    counts[c] += 1.0;
    list_.push_back({channel, test, sample, value, std.value_or(0.0)});
  };
  for (std::size_t i = 0; i < data_.wheels.size(); ++i)
    for (int c = 0; c < kWheelChannels; ++c) {
      const auto channel = static_cast<SoilChannel>(c);
      const SoilReading& reading = data_.wheels[i][channel];
      if (reading.value) add(channel, i, 0, *reading.value, reading.std);
    }
  for (std::size_t i = 0; i < data_.plates.size(); ++i) {
    const PlateRecord& plate = data_.plates[i];
    for (std::size_t s = 0; s < std::min(plate.sinkage_m.size(), plate.pressure_pa.size()); ++s)
      if (plate.sinkage_m[s] > 0.0) add(SoilChannel::kPressure, i, s, plate.pressure_pa[s], std::nullopt);
  }
  for (SoilDatum& datum : list_) {
    const auto c = static_cast<std::size_t>(datum.channel);
    if (datum.std > 0.0) continue;
    const double rms = std::sqrt(squares[c] / counts[c]);
    datum.std = std::hypot(noise.share * datum.measured, noise.share_of_rms * rms);
    if (!(datum.std > 0.0)) datum.std = 1.0;  // every reading is 0
  }
}

std::size_t SoilObservations::sunk() const {
  std::size_t count = 0;
  for (const Group& group : groups_)
    count += static_cast<std::size_t>(std::count(group.sunk.begin(), group.sunk.end(), true));
  return count;
}

// Secant steps from where the wheels stood, all at once; the library's own solver for those that these do not
// settle.
void SoilObservations::balance(Group& g) {
  const std::size_t count = g.tests.size();
  const auto evaluate = [&](std::span<const double> angles, std::span<sim::WheelForces> forces) {
    sim::wheel_forces(g.wheel, g.soils, angles, g.motions, forces);
  };
  const auto solve_alone = [&](std::size_t i) {
    const auto angle = sim::balanced_entry_angle_rad(g.wheel, g.soils[i], g.loads_n[i], g.motions[i]);
    g.sunk[i] = !angle.has_value();
    g.angles[i] = angle.value_or(sim::kMaxEntryAngleRad);
  };
  for (std::size_t i = 0; i < count; ++i)
    if (!g.held[i] && (!g.warm || g.sunk[i])) solve_alone(i);
  if (!g.warm) {
    constexpr double kStep = 1e-5;
    evaluate(g.angles, g.before);
    for (std::size_t i = 0; i < count; ++i) g.tried[i] = g.angles[i] + kStep;
    evaluate(g.tried, g.forces);
    for (std::size_t i = 0; i < count; ++i)
      g.slopes[i] = (g.forces[i].vertical_n - g.before[i].vertical_n) / kStep;
    g.warm = true;
  }
  constexpr int kMaxSteps = 8;
  for (int step = 0; step <= kMaxSteps; ++step) {
    evaluate(g.angles, g.forces);
    bool settled = true, alone = false;
    for (std::size_t i = 0; i < count; ++i) {
      if (g.held[i] || g.sunk[i]) continue;
      const double surplus = g.forces[i].vertical_n - g.loads_n[i];
      if (std::abs(surplus) <= kOfLoad * g.loads_n[i]) {
        g.tried[i] = g.angles[i];
        continue;
      }
      settled = false;
      if (step > 0 && g.angles[i] != g.tried[i]) {
        const double slope = (g.forces[i].vertical_n - g.before[i].vertical_n) / (g.angles[i] - g.tried[i]);
        if (slope > 0.0) g.slopes[i] = slope;
      }
      const double next = g.angles[i] - surplus / g.slopes[i];
      g.tried[i] = g.angles[i];
      if (step == kMaxSteps || !(g.slopes[i] > 0.0) || !(next > kMinAngle) ||
          !(next < sim::kMaxEntryAngleRad)) {
        solve_alone(i);
        alone = true;
      } else {
        g.angles[i] = next;
      }
    }
    if (settled) return;
    if (step == kMaxSteps && !alone) return;
    g.before = g.forces;
  }
  evaluate(g.angles, g.forces);
}

// As sim::run_wheel_rig splits the pull: thrust is what strength and grousers add to it.
void SoilObservations::find_thrust(Group& g) {
  std::vector<sim::Soil> soils = g.soils;
  for (sim::Soil& soil : soils) soil.bulldozing = soil.side_bulldozing = 0.0;
  sim::wheel_forces(g.wheel, soils, g.angles, g.motions, g.before);
  for (std::size_t i = 0; i < soils.size(); ++i) {
    g.thrusts[i] = g.before[i].drawbar_pull_n;
    soils[i].cohesion_pa = soils[i].friction_angle_rad = 0.0;
  }
  sim::WheelGeometry smooth = g.wheel;
  smooth.grousers = {};
  sim::wheel_forces(smooth, soils, g.angles, g.motions, g.before);
  for (std::size_t i = 0; i < soils.size(); ++i) g.thrusts[i] -= g.before[i].drawbar_pull_n;
}

bool SoilObservations::predict(const sim::Soil& soil, std::span<double> values) {
  ++evaluations_;
  for (Group& g : groups_) {
    if (!(soil.pressure.stiffness(g.wheel.width_m) > 0.0)) return false;
    for (std::size_t i = 0; i < g.tests.size(); ++i) {
      const sim::WheelRigConditions& test = data_.wheels[g.tests[i]].test;
      g.soils[i] = sim::soil_in_force(soil, test.gravity_m_s2, g.rim_speeds_m_s[i], test.in_a_track);
    }
    balance(g);
    if (g.any_thrust) find_thrust(g);
  }
  for (std::size_t k = 0; k < list_.size(); ++k) {
    const SoilDatum& datum = list_[k];
    if (datum.channel == SoilChannel::kPressure) {
      const PlateRecord& plate = data_.plates[datum.test];
      const double stiffness = soil.pressure.stiffness(plate.radius_m);
      if (!(stiffness > 0.0)) return false;
      values[k] = sim::bekker_pressure_pa(stiffness, soil.pressure.n, plate.sinkage_m[datum.sample]);
      continue;
    }
    const auto [group, i] = place_[datum.test];
    const Group& g = groups_[group];
    const sim::WheelForces& forces = g.forces[i];
    switch (datum.channel) {
      case SoilChannel::kTorque:
        values[k] = forces.torque_nm;
        break;
      case SoilChannel::kDrawbarPull:
        values[k] = forces.drawbar_pull_n;
        break;
      case SoilChannel::kThrust:
        values[k] = g.thrusts[i];
        break;
      case SoilChannel::kSinkage:
        values[k] = sim::sinkage_m(g.wheel.radius_m, g.angles[i]);
        break;
      default:
        values[k] = sim::motor_state(*data_.wheels[datum.test].test.drive, forces.torque_nm,
                                     g.rim_speeds_m_s[i] / g.wheel.radius_m)
                        .current_a;
    }
  }
  return true;
}

}  // namespace slipway::gap
