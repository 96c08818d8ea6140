#pragma once

#include <optional>

#include "sim/quasi_static/quasi_static.h"

namespace slipway::sim {

// The nose-up pitch beyond which a rover on a plane of one soil, at a given roll, makes no more headway.
// There its speed along its heading, v_x, falls below the speed v_y at which it slides across (and without a
// side slope to 2 % of the commanded speed):
//
//   v_x^2 = v_y^2 + (0.02 v_commanded)^2
//
// A motor may stall or a wheel lift before this limit. Beyond it a rover slides down more than it drives, and
// on some soils its motion jumps, because the wheels suddenly spin and no longer hold the rover sideways. One
// search object serves a row of rolls, since each limit helps to find the next.
class TractionLimitSearch {
 public:
  // The search is between two pitches, nose up (negative) and nose down. Rover and soil must outlive it.
  TractionLimitSearch(const RoverModel& rover, double gravity_m_s2, const Soil& soil,
                      const DriveCommand& command, double steepest_climb_rad, double steepest_descent_rad);

  // The limit to within a few hundredths of a degree, on the side where the rover makes headway. It is the
  // steepest climb where the rover still makes headway there, and empty where it does at no pitch.
  // `guess_rad` is the limit at a neighbouring roll.
  std::optional<double> find(double roll_rad, std::optional<double> guess_rad);

 private:
  // The speed ratio along the heading less the one needed; negative where the rover makes no headway.
  double surplus(double roll_rad, double pitch_rad);
  struct Trial {
    double pitch_rad = 0.0, surplus = 0.0;
  };
  // The first pitch, from from_rad on by this step, at which the rover makes headway.
  std::optional<Trial> find_moving(double roll_rad, double from_rad, double step_rad);

  const RoverModel& rover_;
  const Soil& soil_;
  DriveCommand command_;
  double min_pitch_rad_, max_pitch_rad_;
  QuasiStaticSolver solver_;
};

}  // namespace slipway::sim
