#pragma once

#include <optional>

#include "sim/quasi_static.h"

namespace slipway::sim {

// The nose-up pitch at which a rover on a plane of one soil, at a given roll, comes to a stand: the lowest pitch
// from which on it moves. In slip this is where the wheels spin; a motor that stalls or a wheel that lifts may
// come before. One search for a row of rolls: each limit found helps to find the next.
class TractionLimitSearch {
 public:
  // Looks between two pitches, nose up (negative) and nose down. What it refers to must outlive it.
  TractionLimitSearch(const RoverModel& rover, double gravity_m_s2, const Soil& soil,
                      const DriveCommand& command, double steepest_climb_rad, double steepest_descent_rad);

  // The limit to within a few hundredths of a degree, on the side where the rover moves; the steepest climb where
  // it still moves there; nothing where it moves at no pitch. `guess_rad`: of a neighbouring roll.
  std::optional<double> find(double roll_rad, std::optional<double> guess_rad);

 private:
  // The speed ratio beyond that of spinning wheels, negative where the rover does not move.
  double surplus(double roll_rad, double pitch_rad);
  std::optional<double> moving_pitch(double roll_rad, double from_rad, double step_rad);

  const RoverModel& rover_;
  const Soil& soil_;
  DriveCommand command_;
  double lowest_rad_, highest_rad_;
  QuasiStaticSolver solver_;
};

}  // namespace slipway::sim
