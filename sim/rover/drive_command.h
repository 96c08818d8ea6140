#pragma once

#include <optional>
#include <string>

#include "sim/rover/rover_model.h"
#include "sim/wheel/per_wheel.h"

namespace slipway::sim {

// What a drive is made under, besides ground and soil.
struct DriveConditions {
  std::optional<double> motor_temp_c = {};  // of the drive motors; nothing: what they are given at
};

// What the driver asks for at a station.
struct DriveCommand {
  double speed_m_s = 0.04;  // of B along its direction of travel; negative drives backwards; never 0; unused
                            // when turning in place
  double curvature_1_m = 0.0;  // positive turns left
  bool turn_in_place = false;
  double turn_rate_rad_s = 0.0;  // when turning in place; positive turns left; never 0 there
  double crab_rad = 0.0;  // direction of travel from B's x axis, positive to the left; unused when turning
  std::optional<double> motor_temp_c = {};  // nothing: what the motors are given at
};

// The direction of travel of a positive speed, unit, B's x-y plane: (cos crab, sin crab); x when turning in
// place.
Eigen::Vector2d travel_direction(const DriveCommand& command);

// The commands of the wheels: Ackermann steering about the turn's centre and the rate that would roll without
// slip on the radius that the rover's software believes in.
struct WheelCommand {
  double steer_rad = 0.0;
  double rate_rad_s = 0.0;  // positive rolls forward
};

// Steerable wheels point along the path of a rover turning about its centre; the others stay straight and are
// commanded the forward part of their place's velocity, which is skid steering. Rates are scaled down
// together where one would exceed the motor's maximum.
PerWheel<WheelCommand> wheel_commands(const RoverModel& rover, const DriveCommand& command);

// The share of the commanded speed that the motors' greatest rate allows, in (0, 1].
double attainable_share(const RoverModel& rover, const DriveCommand& command);

// Why the rover can't travel in that direction from its x axis: none of its wheels steers. Nothing where it
// can, though wheels that don't steer be dragged.
std::optional<std::string> why_no_crab(const RoverModel& rover, double crab_rad);

// How a wheel really stands and turns under its command: steered by its offset, turning at its share of the
// rate; not at all where it is locked. A free wheel's rate is the ground's to say: here the commanded one.
WheelCommand true_motion(const WheelModel& wheel, const WheelCommand& commanded);

}  // namespace slipway::sim
