#pragma once

#include "core/pose.h"
#include "sim/rover/drive_command.h"

namespace slipway::sim {

// One piece of a drive: an arc, a straight, a crab or a turn in place, between two halts at which the wheels
// are steered.
struct DriveLeg {
  DriveCommand command;   // speed and turn rate as asked for on the way; their signs say which way
  double length_m = 0.0;  // >= 0, of B's way, commanded; unused when turning in place
  double turn_rad = 0.0;  // >= 0, when turning in place
};

// Driven at the asked rate without ramps.
double commanded_duration_s(const DriveLeg& leg);

// The pose of B that a rover without slip has after a share of the leg, in [0, 1] and beyond.
Pose2 commanded_pose(const DriveLeg& leg, const Pose2& start, double share);

// How a rover that sees its own pose keeps to its legs.
enum class Feedback {
  kNone,     // wheel rates for the commanded time, as ROAMS's FIDO drives: slip leaves it short of the goal
  kHeading,  // the same, the heading held to the leg's
  kPose,     // heading and distance to the leg's line steer; a leg ends where its length or turn is done
};

// Where a rover is with respect to a leg: of a straight or arc, driven in the leg's own sense.
struct LegPlace {
  double share = 0.0;        // of the leg's length or turn that is done; may be negative or above 1
  double across_m = 0.0;     // of B to the leg's line, positive to the left of its travel; 0 when turning
  double heading_rad = 0.0;  // of B less the leg's there, wrapped
};

// turned_rad: the heading's change since the leg's start, unwrapped; read when turning in place, and to tell
// an arc's full turns apart. A leg of no length or turn is done: its share is 1.
LegPlace place_on_leg(const DriveLeg& leg, const Pose2& start, const Pose2& now, double turned_rad);

}  // namespace slipway::sim
