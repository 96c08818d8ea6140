#pragma once

#include <cstdint>
#include <optional>

#include "planner/problem/departure.h"
#include "sim/prediction/drive_prediction.h"
#include "sim/rover/rover_model.h"

namespace slipway::planner {

// What follows the departure's air, which there must be, with a time constant; 0: the air itself. The air
// swings as a cosine over the day, so that what follows it does, smaller and later:
//
//   T = mean + swing cos(phase - atan(w tau)) / sqrt(1 + (w tau)^2),  w = 2 pi / day
class FollowingAir {
 public:
  explicit FollowingAir(const Departure& departure, double time_constant_s = 0.0);
  double at_c(std::int64_t utc_ms) const;

 private:
  double mean_c_, swing_k_, rad_per_ms_, lag_rad_;
  std::int64_t noon_ms_;
};

// Losses of the drive motors and their gears at a station, of the one that loses most and of the one that
// loses least: electric power less that of the turning wheel, W. Motors by their constants at the reference
// temperature. Both 0 on ground that is known by a slip curve.
struct MotorLosses {
  double most_w = 0.0, least_w = 0.0;
};
MotorLosses motor_losses(const sim::RoverModel& rover, const sim::StationState& state);

// The first-order model by which data sheets of motors give their temperature, with one thermal equivalent
// time constant [IEC 60034-1]:
//
//   tau dT/dt = T_air + R P - T
//
//   R  thermal resistance to the air, K/W    tau  time constant, s    P  losses, W
//
// It is linear: T is what follows the air alone, and the warmth over it by the motor's own losses, which is 0
// when the drive begins.
struct MotorWarmth {
  double resistance_k_w = 0.0, time_constant_s = 1.0;

  // What is left of a warmth of `over_k`, and has come to it, after losses that last for some time.
  double after(double over_k, double losses_w, double seconds) const;
};
// Nothing where the rover's file lacks a number of it.
std::optional<MotorWarmth> motor_warmth(const sim::DriveMotor& drive);

}  // namespace slipway::planner
