#pragma once

#include <optional>
#include <vector>

#include "core/result.h"

namespace slipway::sim {

// Ground as planners without a soil model know it: the slip of rovers that were driven on slopes, tabulated.
//
//   slip ratio (slope_rad)            of the rover along its direction of travel, over the slope in that
//   direction,
//                                     uphill positive; 1 - v / v_commanded where it is driven, as in
//                                     slip_ratio.h
//   side slip angle (cross_slope_rad) between the way made good and the commanded direction, downhill, over
//   the slope
//                                     across the direction of travel
//
// Linear between the tabulated slopes; nothing is known beyond them. Curves of this kind were measured for
// the Mars exploration rovers on a tilt table and used to plan their drives [Lindemann 2005], and are learnt
// from drives [Angelova 2007]. They hold for the rover, the load and the gravity that they were measured
// with.
//
// What they do not say is not answered either: sinkage, wheel loads, torques, currents, energy, ruts. Slip
// turning in place was not measured with them; it is taken to be the slip on the level.
//
// Properties: the tabulated slip at a tabulated slope; between its neighbours' slips between them; mirrored
// left to right.
struct SlipCurve {
  std::vector<double> slope_rad;  // strictly rising, 0 among or between them
  std::vector<double> slip_ratio;
  std::vector<double> cross_slope_rad;  // strictly rising from 0
  std::vector<double> side_slip_rad;    // from 0

  // Nothing outside the tabulated slopes.
  std::optional<double> slip_at(double slope_rad) const;
  std::optional<double> side_slip_at(double cross_slope_rad) const;  // positive for a positive cross slope
};

// Pointers are the columns of the soil's file, "/slip_curve/slope_deg".
std::vector<Fault> faults_of(const SlipCurve& curve);

}  // namespace slipway::sim
