#pragma once

#include <array>
#include <cstddef>

#include "sim/rover/rover_model.h"
#include "sim/soil/soil.h"

namespace slipway::steps {

// The slip that a rover's visual odometry would measure on inclined planes of one soil, by the quasi-static
// balance: 1 less the way made good over the way by odometry, which reckons with the wheels' reckoned radius.
// A table over pitch and roll, linear between its nodes and constant beyond them; the sign of the roll
// changes nothing. Where the rover does not move, the slip is 1.
class PlaneSlips {
 public:
  PlaneSlips(const sim::RoverModel& rover, double gravity_m_s2, const sim::Soil& soil);

  // `pitch_rad` is positive where the rover climbs.
  double at(double pitch_rad, double roll_rad) const;

 private:
  static constexpr std::size_t kPitches = 31, kRolls = 3;
  std::array<std::array<double, kPitches>, kRolls> slips_{};
};

}  // namespace slipway::steps
