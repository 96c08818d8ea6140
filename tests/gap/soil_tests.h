#pragma once

#include <cstdint>
#include <stdexcept>

#include "core/angle.h"
#include "core/random.h"
#include "gap/estimate/soil_estimation.h"

namespace slipway::gap {

// Dry sand [Wong 2010, Table 2.3], with less cohesion than printed: that of clean sand.
inline sim::Soil dry_sand() {
  sim::Soil soil;
  soil.pressure = {990.0, 1.528e6, 1.1};
  soil.cohesion_pa = 100.0;
  soil.friction_angle_rad = rad_from_deg(28.0);
  soil.shear_modulus_x_m = soil.shear_modulus_y_m = 0.015;
  return soil;
}

// Every parameter 49 % off, as the ARTEMIS paper's case study starts.
inline sim::SoilDistribution start_49_percent_off(const sim::Soil& truth, double sign = 1.0) {
  const double up = 1.0 + 0.49 * sign, down = 1.0 - 0.49 * sign;
  sim::SoilDistribution start;
  start.name = "start";
  start.mean = truth;
  start.mean.pressure.k_c *= down;
  start.mean.pressure.k_phi *= down;
  start.mean.pressure.n *= up;
  start.mean.cohesion_pa *= down;
  start.mean.friction_angle_rad *= up;
  start.mean.shear_modulus_x_m *= down;
  start.mean.shear_modulus_y_m *= down;
  start.std = {0.25, 0.05, 60.0, rad_from_deg(2.0), 0.25};
  return start;
}

inline Result<SoilEstimate> estimate(const sim::SoilDistribution& start, const SoilData& data,
                                     const SoilEstimationOptions& options = {}) {
  NoProgress progress;
  return estimate_soil(start, data, options, progress);
}

// Of what was estimated; the test ends where it was not.
inline const EstimatedParameter& of(const SoilEstimate& estimate, SoilParameter parameter) {
  for (const EstimatedParameter& p : estimate.parameters)
    if (p.parameter == parameter) return p;
  throw std::logic_error("not estimated");
}

// Share by which an estimate is off the truth.
inline double off(const SoilEstimate& e, SoilParameter parameter, const sim::Soil& truth) {
  return of(e, parameter).value / value_of(parameter, truth, e.width_m) - 1.0;
}

struct MadeWheelTests {
  int count = 50;
  double noise = 0.0;  // share of every reading
  std::uint64_t seed = 1;
  bool torque = true, pull = false, thrust = true, sinkage = true, current = false;
};

// What a rig with a wheel of 0.125 m would report on a soil, over loads and slips.
inline SoilData made_wheel_tests(const sim::Soil& soil, const MadeWheelTests& made) {
  SoilData data;
  const sim::WheelGeometry wheel{.radius_m = 0.125, .width_m = 0.16};
  data.rigs = {rig_of_wheel(wheel, sim::DriveMotor{})};
  for (int i = 0; i < made.count; ++i) {
    WheelObservation o;
    o.test.wheel = wheel;
    o.test.load_n = 20.0 + 70.0 * (i % 5);
    const int slip_step = i / 5;
    o.test.slip = 0.03 + 0.75 * slip_step / std::max(1.0, made.count / 5.0 - 1.0);
    if (made.current) o.test.drive = sim::DriveMotor{};
    sim::WheelRigConditions test = o.test;
    test.soil = soil;
    const sim::WheelRigResult result = sim::run_wheel_rig(test);
    const auto noisy = [&](double value, SoilChannel channel) {
      const auto counter =
          std::uint64_t{10} * static_cast<std::uint64_t>(i) + static_cast<std::uint64_t>(channel);
      return value * (1.0 + made.noise * random_normal(random_key(made.seed, 7), counter));
    };
    const auto put = [&](bool wanted, SoilChannel channel, double value) {
      if (wanted) o[channel].value = noisy(value, channel);
    };
    put(made.torque, SoilChannel::kTorque, result.forces.torque_nm);
    put(made.pull, SoilChannel::kDrawbarPull, result.forces.drawbar_pull_n);
    put(made.thrust, SoilChannel::kThrust, result.thrust_n);
    put(made.sinkage, SoilChannel::kSinkage, result.sinkage_m);
    if (made.current) put(true, SoilChannel::kCurrent, result.current_a.value_or(0.0));
    data.wheels.push_back(o);
  }
  return data;
}

}  // namespace slipway::gap
