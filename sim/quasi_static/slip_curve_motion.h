#pragma once

#include <optional>
#include <string>

#include "sim/quasi_static/quasi_static.h"

namespace slipway::sim {

// Slopes of the ground under the body: along the way that it goes, uphill positive, and across the command's
// direction of travel, positive where its left side is up (also of a rover that drives backwards).
struct TravelSlopes {
  double along_rad = 0.0, across_rad = 0.0;
};
TravelSlopes travel_slopes(const Eigen::Matrix3d& R_MB, const DriveCommand& command);

// Slip of a rover on a soil with a slip curve, the soil's deviation from the curve included.
struct SlipOnCurve {
  double slip_ratio = 0.0;     // [-1, 1]
  double side_slip_rad = 0.0;  // positive to the left
  bool outside = false;        // of the tabulated slopes: nothing else is known
};
SlipOnCurve slip_on_curve(const Soil& soil, const TravelSlopes& slopes);

// The motion of a rover of which at least one wheel stands on a soil with a slip curve: that of the curve
// with the most slip among its wheels'. Forces, loads, sinkage, currents and power are not known
// (StationState::by_slip_curve).
StationState motion_on_slip_curves(const RoverModel& rover, const Stance& stance, const PerWheel<Soil>& soils,
                                   const DriveCommand& command);

}  // namespace slipway::sim
