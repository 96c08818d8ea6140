#pragma once

#include "core/pose.h"
#include "sim/rover/drive_command.h"

namespace slipway::sim {

// One piece of a drive: an arc, a straight line, a crab or a turn in place, between two halts at which the
// wheels are steered.
struct DriveLeg {
  DriveCommand command;   // its signs of speed and turn rate give the direction
  double length_m = 0.0;  // >= 0, commanded length of B's path; unused when turning in place
  double turn_rad = 0.0;  // >= 0, commanded angle of a turn in place
};

// The time that the leg takes at its commanded speed or turn rate without ramps; infinite at rate 0.
double commanded_duration_s(const DriveLeg& leg);

// The pose of B that a rover without slip has after a share of the leg, in [0, 1] and beyond.
Pose2 commanded_pose(const DriveLeg& leg, const Pose2& start, double share);

// How the rover uses its own pose to keep to its legs.
enum class Feedback {
  kNone,  // wheel rates for the commanded time, as in ROAMS's FIDO drives; slip leaves it short of the goal
  kHeading,  // the same, but steering holds the leg's heading
  kPose,     // steering holds heading and line of the leg, which ends where its length or turn is done
};

// Where a rover is with respect to a leg.
struct LegPlace {
  double share = 0.0;     // of the leg's length or turn that is done; may be negative or above 1
  double across_m = 0.0;  // distance of B to the leg's line, positive to the left of its travel; 0 in a turn
  double heading_rad = 0.0;  // heading of B less the leg's at that place, wrapped
};

// turned_rad: the change of heading since the leg's start, unwrapped. It is used when turning in place, and
// to count an arc's full turns. The share of a leg without length or turn is 1.
LegPlace place_on_leg(const DriveLeg& leg, const Pose2& start, const Pose2& now, double turned_rad);

}  // namespace slipway::sim
