#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

#include "core/pose.h"
#include "sim/rover/ground.h"
#include "sim/rover/rover_model.h"
#include "sim/wheel/per_wheel.h"
#include "sim/wheel/sliced_wheel.h"

namespace slipway::sim {

// One a slice of RoverModel::wheel_slices; the others are 0.
using SliceHeights = std::array<double, kMaxSlices>;

// How the rover stands on undeformed ground: the suspension's angles and where every wheel touches.
struct Stance {
  Eigen::Vector3d p_MB = Eigen::Vector3d::Zero();
  Attitude attitude;
  Eigen::Matrix3d R_MB = Eigen::Matrix3d::Identity();
  double rocker_rad = 0.0;                                   // left rocker; the right one is its negative
  std::array<double, 2> bogie_rad{};                         // left, right, relative to their rockers
  Eigen::Vector3d p_B_left_bogie = Eigen::Vector3d::Zero();  // bogie pivots in B
  Eigen::Vector3d p_B_right_bogie = Eigen::Vector3d::Zero();
  PerWheel<Eigen::Vector3d> p_B_wheel;  // wheel centres in B
  PerWheel<Eigen::Vector3d> normal_B;   // ground normal under each wheel, in B
  // Height of each wheel's rim over the ground along its normal, negative where it would cut into it. Only a
  // suspension with fewer joints than its wheels need leaves any: none of a rocker-bogie's.
  PerWheel<double> gap_m;
  // Height of the ground under each slice of a wheel, from right to left across its axle as it stands
  // unsteered, over the plane parallel to the axle through the point under the wheel's middle; empty where
  // wheels are not sliced.
  PerWheel<SliceHeights> slice_height_m;
  double belly_clearance_m = 0.0;  // least height of the belly plane over the ground under the body
};

// Sets the rover down at a pose: one equation a wheel, that it touches, for height, roll, pitch and the
// suspension's joints. A suspension with fewer unknowns than wheels (rigid on four) is fitted to the ground
// by least squares over the gaps. Nothing where a wheel has no ground under it, or where the suspension finds
// no stance within its linkage's reach.
std::optional<Stance> settle(const RoverModel& rover, const Ground& ground, const Pose2& pose);

// The rover at rest in its joints on the plane that fits the ground under its wheels best (least squares over
// heights): what a recording shows whose attitude is not a suspension's. Nothing where a wheel has no ground
// under it.
std::optional<Stance> lay_on_fitted_plane(const RoverModel& rover, const Ground& ground, const Pose2& pose);

// The stance on an inclined plane in closed form: what settle() finds there.
Stance stance_on_plane(const RoverModel& rover, const Attitude& attitude);

}  // namespace slipway::sim
