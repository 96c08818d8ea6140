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

struct SoilChannelRow {
  SoilChannel channel;
  std::string_view name, unit;
};
constexpr std::array<SoilChannelRow, kSoilChannels> kRows{{{SoilChannel::kTorque, "torque", "N m"},
                                                           {SoilChannel::kDrawbarPull, "drawbar_pull", "N"},
                                                           {SoilChannel::kThrust, "thrust", "N"},
                                                           {SoilChannel::kSinkage, "sinkage", "m"},
                                                           {SoilChannel::kCurrent, "current", "A"},
                                                           {SoilChannel::kLateralForce, "lateral_force", "N"},
                                                           {SoilChannel::kPressure, "pressure", "Pa"}}};

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
  for (const SoilChannelRow& row : kRows)
    if (row.name == name) return row.channel;
  return std::nullopt;
}

TestRig rig_of_wheel(const sim::WheelGeometry& wheel, const std::optional<sim::DriveMotor>& drive) {
  TestRig rig;
  sim::WheelModel& model = rig.rig.rover.wheels.emplace_back();
  model.radius_m = wheel.radius_m;
  model.width_m = wheel.width_m;
  model.grousers = wheel.grousers;
  model.rim_friction = wheel.rim_friction;
  if (drive) rig.rig.rover.drive = *drive;
  return rig;
}

SoilObservations::SoilObservations(const SoilData& data, const ReadingNoise& noise,
                                   const std::array<bool, kSoilChannels>& used)
    : data_(data) {
  groups_.resize(data.rigs.size());
  double narrowest = std::numeric_limits<double>::infinity(), widest = 0.0;
  for (const TestRig& rig : data.rigs) {
    const double width = rig.rig.rover.wheels[rig.rig.wheel].width_m;
    narrowest = std::min(narrowest, width);
    widest = std::max(widest, width);
  }
  width_m_ = narrowest;
  for (const PlateRecord& plate : data.plates) {
    narrowest = std::min(narrowest, plate.radius_m);
    widest = std::max(widest, plate.radius_m);
  }
  if (data.rigs.empty()) width_m_ = narrowest;
  one_width_ = !(widest > narrowest);
  for (std::size_t i = 0; i < data.wheels.size(); ++i) add_test(i);
  list_readings(noise, used);
}

void SoilObservations::add_test(std::size_t test) {
  const WheelObservation& observation = data_.wheels[test];
  Group& group = groups_[observation.rig];
  place_.push_back(group.tests.size());
  group.tests.push_back(test);
  group.loads_n.push_back(observation.test.load_n);
  group.held.push_back(observation.test.sinkage_m.has_value());
  group.sunk.push_back(false);
  group.angles.push_back(0.3);
  group.any_thrust = group.any_thrust || observation[SoilChannel::kThrust].value.has_value();
  const std::size_t count = group.tests.size();
  group.motions.resize(count);
  group.rim_speeds_m_s.resize(count);
  group.slopes.resize(count);
  group.soils.resize(count);
  group.forces.resize(count);
  group.before.resize(count);
  group.tried.resize(count);
  group.thrusts.resize(count);
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
    g.angles[i] = angle.value_or(sim::max_entry_angle_rad(g.soils[i]));
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
          !(next < sim::max_entry_angle_rad(g.soils[i]))) {
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
  for (sim::Soil& soil : soils) {
    soil.bulldozing = soil.side_bulldozing = 0.0;
    soil.ploughing = {};
  }
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

// The tests of a rig with what stands on it now.
void SoilObservations::put_on(const RigAt& rig, Group& g) {
  g.wheel = rig.wheel;
  g.drive = rig.drive;
  for (std::size_t i = 0; i < g.tests.size(); ++i) {
    sim::WheelRigConditions test = data_.wheels[g.tests[i]].test;
    test.wheel = rig.wheel;
    if (test.slip_radius == sim::SlipRadius::kShear) test.soil = rig.soil;
    g.motions[i] = sim::motion_of(test);
    g.rim_speeds_m_s[i] = sim::rim_speed_m_s(test);
    g.soils[i] =
        sim::soil_in_force(rig.soil, test.gravity_m_s2, g.rim_speeds_m_s[i], test.in_a_track ? 1.0 : 0.0);
    if (test.sinkage_m) g.angles[i] = sim::entry_angle_rad(rig.wheel.radius_m, *test.sinkage_m);
  }
}

bool SoilObservations::predict(const sim::Soil& soil, std::span<double> values) {
  std::vector<RigAt> rigs;
  for (const TestRig& on : data_.rigs) {
    sim::WheelRig rig = on.rig;
    rig.soil = soil;
    const sim::WheelRigConditions test = sim::conditions_of(rig);
    rigs.push_back({test.wheel, test.soil, test.drive});
  }
  return predict(rigs, soil, values);
}

bool SoilObservations::predict(std::span<const RigAt> rigs, const sim::Soil& of_plates,
                               std::span<double> values) {
  ++evaluations_;
  for (std::size_t r = 0; r < groups_.size(); ++r) {
    if (!(rigs[r].soil.pressure.stiffness(rigs[r].wheel.width_m) > 0.0)) return false;
    Group& g = groups_[r];
    put_on(rigs[r], g);
    balance(g);
    if (g.any_thrust) find_thrust(g);
  }
  for (const PlateRecord& plate : data_.plates)
    if (!(of_plates.pressure.stiffness(plate.radius_m) > 0.0)) return false;
  for (std::size_t k = 0; k < list_.size(); ++k) {
    const SoilDatum& datum = list_[k];
    if (datum.channel != SoilChannel::kPressure) {
      values[k] = value_of(datum);
      continue;
    }
    const PlateRecord& plate = data_.plates[datum.test];
    values[k] = sim::bekker_pressure_pa(of_plates.pressure.stiffness(plate.radius_m), of_plates.pressure.n,
                                        plate.sinkage_m[datum.sample]);
  }
  return true;
}

// Of a wheel, as its rig stands.
double SoilObservations::value_of(const SoilDatum& datum) const {
  const Group& g = groups_[data_.wheels[datum.test].rig];
  const std::size_t i = place_[datum.test];
  const sim::WheelForces& forces = g.forces[i];
  switch (datum.channel) {
    case SoilChannel::kTorque:
      return forces.torque_nm;
    case SoilChannel::kDrawbarPull:
      return forces.drawbar_pull_n;
    case SoilChannel::kThrust:
      return g.thrusts[i];
    case SoilChannel::kSinkage:
      return sim::sinkage_m(g.wheel.radius_m, g.angles[i]);
    case SoilChannel::kLateralForce:
      return forces.lateral_n;
    default:
      break;
  }
  return sim::motor_state(*g.drive, forces.torque_nm, g.rim_speeds_m_s[i] / g.wheel.radius_m).current_a;
}

}  // namespace slipway::gap
