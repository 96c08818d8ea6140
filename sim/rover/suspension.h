#pragma once

#include "sim/rover/stance.h"

namespace slipway::sim {

// A suspension's joints turn about B's y axis. In their order:
//
//   rocker-bogie  0 the differential: left rocker by +1, right rocker by -1, each with its bogie
//                 1, 2 the left and the right bogie against their rockers
//   averaging     0 the differential
//   rigid         none
constexpr int kMaxJoints = 3;

int joint_count(SuspensionType type);

// Of N wheels on J joints, height, roll, pitch and joints can follow 3 + J: the others' loads are statically
// undetermined.
int undetermined_loads(const RoverModel& rover);

// Wheel centres and bogie pivots in B for the stance's angles.
void place_wheels(const RoverModel& rover, Stance& stance);

// What a wheel does when a joint turns, per radian: its centre shifts in B, its carrier turns about y.
//
// By virtual work the same numbers are the joint's balance: a force f at the wheel's centre and a moment m on
// its carrier enter it with f . shift + m_y turn.
struct JointMotion {
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();
  double turn = 0.0;
};
JointMotion joint_motion(const RoverModel& rover, const Stance& stance, std::size_t wheel, int joint);

}  // namespace slipway::sim
