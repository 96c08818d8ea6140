#pragma once

#include <vector>

#include "core/pose.h"
#include "planner/problem/motion.h"

namespace slipway::planner {

// One command of a sequence: a straight drive or an arc, or a turn in place.
struct DriveStep {
  double drive_m = 0.0;   // 0 for a turn in place
  double radius_m = 0.0;  // of an arc, positive to the left; 0 for a straight drive
  double turn_rad = 0.0;  // of a turn in place, positive to the left

  // Of the drive, positive to the left; 0 of a straight one.
  double curvature_1_m() const { return radius_m == 0.0 ? 0.0 : 1.0 / radius_m; }
};

// A command sequence with the pose at which it begins, by the direction of travel.
struct DriveSteps {
  Pose2 start;
  std::vector<DriveStep> steps;
};

// The motion that one command asks for, from where the rover stands.
Motion command_motion(const Pose2& from, const DriveStep& step);

// The motions that the commands ask for, from where the rover stands; at least one.
std::vector<Motion> command_motions(const Pose2& start, const std::vector<DriveStep>& steps);

}  // namespace slipway::planner
