#pragma once

#include "sim/dynamic/drive_leg.h"
#include "sim/wheel/per_wheel.h"

namespace slipway::sim {

// The commands of the rover's software to its wheels on one leg: it steers at a halt, starts gently, drives
// and stops gently.
//
//   t_0 .. t_s   wheels are halted and steer from their present angles to the leg's
//   t_s .. t_r   rates rise as the smooth step p = x^2 (3 - 2 x)
//   t_r .. t_e   cruise; afterwards the rates fall in the same time as they rose
//
// Without pose feedback the cruise ends so that the integral of the rates is that of the commanded length;
// with it the cruise ends when stop() is called.
//
// Feedback changes the leg's curvature by
//
//   d kappa = +-2 (psi - psi_line) / l            + when driving backwards, - forwards
//   psi_line = -a tanh((e / (2 l) + i) / a), a = 45 deg   the heading that leads back to the line
//
// where e is the distance across and psi the heading (see LegPlace). Near the line it brings a rover without
// slip back by e'' + 2 e' / l + e / l^2 = 0 over the driven distance, without overshoot; l is a body length.
// From far away the rover comes back at 45 deg: without that bound it would circle. i is the trim, di/ds =
// 0.07 e / l^2: it takes away the 2 l beta that a rover slipping sideways by the angle beta would stay off
// its line (the roots of x^3 + 2 x^2 + x + 0.14 are real, the slowest brings it in over some 4 l). The change
// is limited smoothly to half the curvature of the tightest arc. Feedback::kHeading leaves e out (psi_line =
// 0).
class LegDriver {
 public:
  LegDriver(const RoverModel& rover, const DriveLeg& leg, Feedback feedback, double start_s,
            const PerWheel<double>& steered_rad);

  double steered_s() const { return steered_s_; }  // end of steering
  double ramped_s() const { return ramped_s_; }    // end of the rising ramp
  double cruised_s() const { return cruised_s_; }  // end of cruise; infinite with pose feedback before stop()
  double end_s() const { return end_s_; }
  double nominal_end_s() const { return nominal_end_s_; }  // end of a rover without slip
  // The rates fall from t on, or from the end of the rising ramp where that is later.
  void stop(double t);
  // See i above; 0 until it is set.
  void trim(double trim_rad) { trim_rad_ = trim_rad; }
  // The share of the leg that is still driven while the rates fall.
  double stopping_share() const { return stopping_share_; }

  // Whether the wheels are halted at t, before the rates rise and after they fell.
  bool halts(double t) const { return t <= steered_s_ || t >= end_s_; }
  // The commanded rates at t as a share of those at cruise, in [0, 1].
  double rate_share(double t) const;
  // The commanded angle and rate of each wheel. The wheel's true motion also has its offsets, its share of
  // the rate and its failures.
  PerWheel<WheelCommand> commanded(double t, const LegPlace& place) const;
  const DriveLeg& leg() const { return leg_; }
  bool uses_pose() const { return feedback_ != Feedback::kNone && !leg_.command.turn_in_place; }

 private:
  double curvature_correction(const LegPlace& place) const;

  const RoverModel& rover_;
  DriveLeg leg_;
  Feedback feedback_;
  PerWheel<double> from_rad_;
  PerWheel<WheelCommand> plain_;  // without feedback
  double start_s_, steered_s_ = 0.0, ramped_s_ = 0.0, cruised_s_ = 0.0, end_s_ = 0.0, nominal_end_s_ = 0.0;
  double ramp_s_ = 1.0, stopping_share_ = 0.0, trim_rad_ = 0.0;
};

// The heading less the leg's own that leads a rover at this place back to the leg's line (psi_line above).
double heading_to_line_rad(const RoverModel& rover, const LegPlace& place, double trim_rad = 0.0);
// The trim after another driven_m at a place; within 30 deg.
double trimmed_rad(const RoverModel& rover, const LegPlace& place, double driven_m, double trim_rad);

}  // namespace slipway::sim
