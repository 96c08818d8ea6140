#include "sim/dynamic/leg_driver.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/angle.h"
#include "core/smooth_step.h"

namespace slipway::sim {
namespace {

constexpr double kRamp_s = 2.0;
// Wheels steer at half of the steering motors' maximum rate, but not faster than flown rovers steer.
constexpr double kSteeringRate_rad_s = 0.1;
constexpr double kSameAngle_rad = 1e-6;
constexpr double kTrimGain = 0.07;
constexpr double kMaxTrim_rad = std::numbers::pi / 6.0;
constexpr double kMaxApproach_rad = 0.25 * std::numbers::pi;  // of a leg's line, from far away

double steering_rate(const RoverModel& rover) {
  const double max_rate = rover.steering.value_or(rover.drive).max_wheel_rate_rad_s;
  return std::min(kSteeringRate_rad_s, 0.5 * max_rate);
}

// Two steering angles half a turn apart roll a wheel the same way, with opposite rates. Returns the one
// nearer to the other command, so that a wheel about to cross a quarter turn rolls on rather than swing
// round.
WheelCommand nearest_to(const WheelCommand& other, WheelCommand commanded) {
  const double apart = commanded.steer_rad - other.steer_rad;
  if (std::abs(apart) <= 0.5 * std::numbers::pi) return commanded;
  return {.steer_rad = commanded.steer_rad - std::copysign(std::numbers::pi, apart),
          .rate_rad_s = -commanded.rate_rad_s};
}

}  // namespace

LegDriver::LegDriver(const RoverModel& rover, const DriveLeg& leg, Feedback feedback, double start_s,
                     const PerWheel<double>& steered_rad)
    : rover_(rover),
      leg_(leg),
      feedback_(feedback),
      from_rad_(steered_rad),
      plain_(wheel_commands(rover, leg.command)),
      start_s_(start_s) {
  double max_turn = 0.0;
  for (std::size_t k = 0; k < plain_.size(); ++k)
    if (rover.wheels[k].steerable)
      max_turn = std::max(max_turn, std::abs(plain_[k].steer_rad - from_rad_[k]));
  // The maximum rate of the smooth step, at half way, is one and a half times its mean.
  steered_s_ = start_s + (max_turn > kSameAngle_rad ? 1.5 * max_turn / steering_rate(rover) : 0.0);
  // A rover whose commanded rates exceed its motors' maximum takes longer.
  const double duration = commanded_duration_s(leg) / attainable_share(rover, leg.command);
  ramp_s_ = std::min(kRamp_s, duration);
  ramped_s_ = steered_s_ + ramp_s_;
  nominal_end_s_ = steered_s_ + duration + ramp_s_;
  stopping_share_ = duration > 0.0 ? 0.5 * ramp_s_ / duration : 0.0;
  cruised_s_ =
      feedback == Feedback::kPose ? std::numeric_limits<double>::infinity() : nominal_end_s_ - ramp_s_;
  end_s_ = cruised_s_ + ramp_s_;
}

void LegDriver::stop(double t) {
  cruised_s_ = std::max(t, ramped_s_);
  end_s_ = cruised_s_ + ramp_s_;
}

double LegDriver::rate_share(double t) const {
  if (ramp_s_ <= 0.0) return 0.0;
  return smooth_step((t - steered_s_) / ramp_s_) * (1.0 - smooth_step((t - cruised_s_) / ramp_s_));
}

double LegDriver::curvature_correction(const LegPlace& place) const {
  const double to_line = feedback_ == Feedback::kPose ? heading_to_line_rad(rover_, place, trim_rad_) : 0.0;
  const double wanted = 2.0 * wrapped_rad(place.heading_rad - to_line) / rover_.body_length_m;
  const double limit = 0.5 / rover_.min_turn_radius_m;
  return (leg_.command.speed_m_s < 0.0 ? 1.0 : -1.0) * limit * std::tanh(wanted / limit);
}

PerWheel<WheelCommand> LegDriver::commanded(double t, const LegPlace& place) const {
  PerWheel<WheelCommand> commanded = plain_;
  if (uses_pose() && t > steered_s_) {
    DriveCommand corrected = leg_.command;
    // The correction rises together with the rates, so that the steering does not jump.
    corrected.curvature_1_m += smooth_step((t - steered_s_) / ramp_s_) * curvature_correction(place);
    commanded = wheel_commands(rover_, corrected);
    for (std::size_t k = 0; k < commanded.size(); ++k)
      if (rover_.wheels[k].steerable) commanded[k] = nearest_to(plain_[k], commanded[k]);
  }
  const double share = rate_share(t);
  const double steered = steered_s_ > start_s_ ? smooth_step((t - start_s_) / (steered_s_ - start_s_)) : 1.0;
  for (std::size_t k = 0; k < commanded.size(); ++k) {
    commanded[k].rate_rad_s *= share;
    commanded[k].steer_rad = from_rad_[k] + steered * (commanded[k].steer_rad - from_rad_[k]);
  }
  return commanded;
}

double heading_to_line_rad(const RoverModel& rover, const LegPlace& place, double trim_rad) {
  const double near = 0.5 * place.across_m / rover.body_length_m + trim_rad;
  return -kMaxApproach_rad * std::tanh(near / kMaxApproach_rad);
}

double trimmed_rad(const RoverModel& rover, const LegPlace& place, double driven_m, double trim_rad) {
  const double l = rover.body_length_m;
  return std::clamp(trim_rad + kTrimGain * place.across_m * driven_m / (l * l), -kMaxTrim_rad, kMaxTrim_rad);
}

}  // namespace slipway::sim
