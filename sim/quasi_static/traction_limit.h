#pragma once

#include <optional>

#include "sim/quasi_static/quasi_static.h"

namespace slipway::sim {

// The nose-up pitch beyond which a rover on a plane of one soil, at a given roll, no longer gets ahead: its
// speed along its heading, v_x, falls below the one at which it slides across, v_y, and on no side slope to
// nothing,
//
//   v_x^2 = v_y^2 + (0.02 v_commanded)^2
//
// A motor that stalls or a wheel that lifts may come before. Past this point a rover slides down more than it
// drives, and on some soils its motion jumps: all at once the wheels spin and hold it sideways no more. One
// search for a row of rolls: each limit found helps to find the next.
class TractionLimitSearch {
 public:
  // Looks between two pitches, nose up (negative) and nose down. What it refers to must outlive it.
  TractionLimitSearch(const RoverModel& rover, double gravity_m_s2, const Soil& soil,
                      const DriveCommand& command, double steepest_climb_rad, double steepest_descent_rad);

  // The limit to within a few hundredths of a degree, on the side where the rover gets ahead; the steepest
  // climb where it still does there; nothing where it does at no pitch. `guess_rad`: of a neighbouring roll.
  std::optional<double> find(double roll_rad, std::optional<double> guess_rad);

 private:
  // The speed ratio along beyond the one needed; negative where the rover does not get ahead.
  double surplus(double roll_rad, double pitch_rad);
  struct Trial {
    double pitch_rad = 0.0, surplus = 0.0;
  };
  // The first pitch from here on, by this step, at which the rover gets ahead.
  std::optional<Trial> find_moving(double roll_rad, double from_rad, double step_rad);

  const RoverModel& rover_;
  const Soil& soil_;
  DriveCommand command_;
  double lowest_rad_, highest_rad_;
  QuasiStaticSolver solver_;
};

}  // namespace slipway::sim
