#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sim/rover/effect_setting.h"
#include "sim/single_wheel/wheel_sweep.h"

namespace slipway::api {

// POST /v1/wheel-sweeps: what would a single-wheel rig report? Names, and what differs from the rover's file.
struct WheelSweepRequest {
  std::string rover;
  std::string wheel;  // "": the rover's first
  std::string soil;
  std::optional<double> radius_m, width_m;
  std::optional<sim::Grousers> grousers;
  std::optional<double> load_n;        // nothing: an equal share of the rover's weight
  std::optional<double> speed_m_s;     // nothing: the rover's cruise speed
  std::optional<double> motor_temp_c;  // nothing: what the motor is given at
  sim::WheelRigConditions test;           // the other conditions
  std::vector<sim::EffectSetting> effects;
  std::vector<sim::SweepSetting> set;
  std::vector<sim::SweepAxis> sweep;
};

// The request with every default filled in, what it means, and its rows.
struct WheelSweepAnswer {
  WheelSweepRequest request;
  sim::WheelSweep sweep;
  std::vector<sim::SweepRow> rows;
};

}  // namespace slipway::api
