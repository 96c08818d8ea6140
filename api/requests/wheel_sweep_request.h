#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sim/quasi_static/quasi_static.h"
#include "sim/rover/effect_setting.h"
#include "sim/single_wheel/wheel_sweep.h"

namespace slipway::api {

// POST /v1/wheel-sweeps asks what a single-wheel rig would report. It has the names of rover, wheel and soil,
// and the values that differ from the rover's file.
struct WheelSweepRequest {
  std::string rover;
  std::string wheel;  // the rover's first where it is empty
  std::string soil;
  std::optional<double> radius_m, width_m;
  std::optional<sim::Grousers> grousers;
  bool grousers_given = false;         // in the request; otherwise they are the rover's
  std::optional<double> load_n;        // an equal share of the rover's weight where it is empty
  std::optional<double> speed_m_s;     // the rover's cruise speed where it is empty
  std::optional<double> motor_temp_c;  // the motor's reference temperature where it is empty
  sim::WheelRigConditions test;        // the other conditions
  std::vector<sim::EffectSetting> effects;
  std::vector<sim::SweepSetting> set;
  bool whole_rover = false;  // on the slope, in the place of one wheel
  bool paired = false;       // row i of the sweep stands at every axis' value i
  std::vector<sim::SweepAxis> sweep;
};

// A whole rover on one slope.
struct RoverOnSlope {
  std::vector<double> at;  // the value of each axis
  double slope_rad = 0.0;
  double weight_n = 0.0;
  sim::StationState state;
  std::vector<std::string> wheels;  // names, in the order of the state's wheels
};

// The request with every default filled in, the sweep that follows from it, and its rows: of the wheel or of
// the whole rover.
struct WheelSweepAnswer {
  WheelSweepRequest request;
  sim::WheelSweep sweep;
  std::vector<sim::SweepRow> rows;
  std::vector<RoverOnSlope> rover_rows;
};

}  // namespace slipway::api
