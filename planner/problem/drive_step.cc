#include "planner/problem/drive_step.h"

#include "core/angle.h"

namespace slipway::planner {

Motion command_motion(const Pose2& from, const DriveStep& step) {
  Motion motion{.from = from, .to = from};
  motion.first_turn_rad = step.turn_rad;
  motion.length_m = step.drive_m;
  motion.curvature_1_m = step.curvature_1_m();
  motion.to = motion.at(step.drive_m);
  motion.to.yaw_rad = wrapped_rad(motion.to.yaw_rad);
  return motion;
}

std::vector<Motion> command_motions(const Pose2& start, const std::vector<DriveStep>& steps) {
  std::vector<Motion> motions;
  Pose2 at = start;
  for (const DriveStep& step : steps) {
    motions.push_back(command_motion(at, step));
    at = motions.back().to;
  }
  if (motions.empty()) motions.push_back({.from = at, .to = at});
  return motions;
}

}  // namespace slipway::planner
