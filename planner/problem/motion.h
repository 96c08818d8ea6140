#pragma once

#include <vector>

#include "core/pose.h"
#include "sim/rover/rover_model.h"

namespace slipway::planner {

// One motion that the rover can drive: a turn in place, then an arc or a straight, then (only where no arc
// fits) another turn in place. Always forward: a backward drive is never proposed.
struct Motion {
  Pose2 from;
  Pose2 to;
  double first_turn_rad = 0.0;  // in place, signed, before driving
  double length_m = 0.0;        // of the arc or straight
  double curvature_1_m = 0.0;   // positive turns left
  double last_turn_rad = 0.0;   // in place, signed, after driving

  double departure_rad() const { return from.yaw_rad + first_turn_rad; }  // heading when driving begins
  double turned_rad() const;                                              // in place, without sign
  // The pose after `driven_m` of the arc, the first turn done; the last turn is not part of it.
  Pose2 at(double driven_m) const;
};

// What a motion model needs of a rover.
struct MotionLimits {
  double min_turn_radius_m = 1.5;
  double cruise_speed_m_s = 0.04;
  double turn_rate_rad_s = 0.03;
};

MotionLimits motion_limits(const sim::RoverModel& rover);

// The only circular arc that leaves `from`'s place and arrives at `to` with its heading, after a turn in
// place onto its tangent: a chord's bearing halves the angle between the two headings, so the arc leaves at
// 2 bearing - to.yaw. Where that arc would be tighter than the least radius, or turn by more than
// 120 deg: turn, straight, turn.
Motion connect(const Pose2& from, const Pose2& to, const MotionLimits& limits);

// Turn in place and straight drive; ends at `to`'s place with the drive's heading.
Motion straight(const Pose2& from, double x_m, double y_m);

// Commanded, without slip.
double duration_s(const Motion& motion, const MotionLimits& limits);

}  // namespace slipway::planner
