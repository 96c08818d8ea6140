#pragma once

#include <array>

#include "sim/rover_model.h"
#include "sim/stance.h"

namespace slipway::sim {

// What the driver asks for at a station.
struct DriveCommand {
  double speed_m_s = 0.04;  // of B along its x axis; negative drives backwards; unused when turning in place
  double curvature_1_m = 0.0;  // positive turns left
  bool turn_in_place = false;
  double turn_rate_rad_s = 0.0;  // when turning in place; positive turns left
};

// What the wheels are told: Ackermann steering about the turn's centre and the rate that would roll without
// slip.
struct WheelCommand {
  double steer_rad = 0.0;
  double rate_rad_s = 0.0;  // positive rolls forward
};

// Steerable wheels point along the path of a rover turning about its centre; the others stay straight. Rates
// are scaled down together where one would exceed the motor's maximum.
std::array<WheelCommand, kWheels> wheel_commands(const RoverModel& rover, const DriveCommand& command);

// The share of the commanded speed that the motors' greatest rate allows, in (0, 1].
double attainable_share(const RoverModel& rover, const DriveCommand& command);

}  // namespace slipway::sim
