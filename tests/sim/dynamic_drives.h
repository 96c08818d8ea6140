#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/angle.h"
#include "sim/dynamic/dynamic_drive.h"
#include "tests/sim/reference_models.h"

namespace slipway::sim {

inline constexpr double kMars = 3.71;

struct Driven {
  DynamicDrive drive;
  std::vector<DriveSample> samples;

  // The last sample at full rates.
  const DriveSample& cruising() const {
    const auto commanded = [](const DriveSample& sample) {
      double fastest = 0.0;
      for (const double rate : sample.commanded_rate_rad_s) fastest = std::max(fastest, std::abs(rate));
      return fastest;
    };
    const DriveSample* best = &samples.front();
    for (const DriveSample& sample : samples)
      if (sample.driving && commanded(sample) >= commanded(*best) * (1.0 - 1e-9)) best = &sample;
    return *best;
  }
};

inline DriveLeg straight(double length_m, double speed_m_s = 0.04) {
  DriveLeg leg;
  leg.command.speed_m_s = speed_m_s;
  leg.length_m = length_m;
  return leg;
}

inline DriveLeg arc(double length_m, double curvature_1_m) {
  DriveLeg leg = straight(length_m);
  leg.command.curvature_1_m = curvature_1_m;
  return leg;
}

inline DriveLeg turn(double turn_rad, double rate_rad_s = 0.03) {
  DriveLeg leg;
  leg.command.turn_in_place = true;
  leg.command.turn_rate_rad_s = rate_rad_s;
  leg.turn_rad = turn_rad;
  return leg;
}

inline FunctionGround plane(double tilt_rad) {
  return FunctionGround([slope = std::tan(tilt_rad)](double x, double) { return slope * x; });
}

inline Result<Driven> try_drive(const RoverModel& rover, const Ground& ground, const Soil& soil,
                                double yaw_rad, const std::vector<DriveLeg>& legs,
                                const DynamicOptions& options = {}) {
  Driven out;
  NoProgress progress;
  DriveSoils soils{{soil}, soil};
  auto drive = simulate_drive(
      rover, kMars, ground, soils, {0.0, 0.0, yaw_rad}, legs, options,
      [&](const DriveSample& sample) { out.samples.push_back(sample); }, progress);
  if (!drive) return fail(drive.error());
  out.drive = std::move(*drive);
  return out;
}

inline Driven drive(const RoverModel& rover, const Ground& ground, const Soil& soil, double yaw_rad,
                    const std::vector<DriveLeg>& legs, const DynamicOptions& options = {}) {
  auto driven = try_drive(rover, ground, soil, yaw_rad, legs, options);
  EXPECT_TRUE(driven) << driven.error().detail;
  return driven ? std::move(*driven) : Driven{};
}

// A rover with all mass in the body and no compliance, as at the quasi-static level.
inline RoverModel light_suspension(RoverModel rover) {
  rover.masses = {.wheel_kg = 1e-3, .rocker_kg = 1e-3, .bogie_kg = 1e-3, .body_inertia_kg_m2 = std::nullopt};
  rover.suspension.differential_stiffness_nm_rad = 1e8;
  return rover;
}

}  // namespace slipway::sim
