#pragma once

#include "sim/dynamic/drive_leg.h"
#include "sim/wheel/per_wheel.h"

namespace slipway::sim {

// What the rover's software tells its wheels on one leg: steer at a halt, start gently, drive, stop gently.
//
//   t_0 .. t_s   wheels halted, steering from where it stood to the leg's angles
//   t_s .. t_r   rates rise as the smooth step p = x^2 (3 - 2 x)
//   t_r .. t_e   cruise; then as long down as it went up
//
// Without feedback of the pose the cruise ends so that the rates' integral is that of the commanded length;
// with it when stop() says so.
//
// Feedback turns the leg's curvature by
//
//   d kappa = +-(e / l^2 + 2 psi / l)      + when driving backwards, - forwards
//
// (e across, psi heading: see LegPlace), which brings a rover without slip back along e'' + 2 e' / l + e /
// l^2 = 0, e over the driven way, without overshoot; l is a body length. Its size is limited smoothly to half
// the tightest arc's. Feedback::kHeading leaves e out.
class LegDriver {
 public:
  LegDriver(const RoverModel& rover, const DriveLeg& leg, Feedback feedback, double start_s,
            const PerWheel<double>& steered_rad);

  double steered_s() const { return steered_s_; }  // end of steering
  double ramped_s() const { return ramped_s_; }
  double cruised_s() const { return cruised_s_; }  // end of cruise; infinite with feedback until stopped
  double end_s() const { return end_s_; }
  double nominal_end_s() const { return nominal_end_s_; }
  // From now on the rates fall.
  void stop(double t);
  // The way that is still driven once the rates begin to fall, as a share of the leg.
  double stopping_share() const { return stopping_share_; }

  // Of the commanded rates that are told at t, in [0, 1].
  double rate_share(double t) const;
  // told to each wheel; true motion (offsets, shares, failures) is the wheel's own.
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
  double ramp_s_ = 1.0, stopping_share_ = 0.0;
};

}  // namespace slipway::sim
