#include "sim/rover/stance.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/rover/belly_clearance.h"
#include "sim/rover/suspension.h"

namespace slipway::sim {
namespace {

// Unknowns: z, roll, pitch, joints.
constexpr int kMaxUnknowns = 3 + kMaxJoints;
using Gaps = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxWheels, 1>;
using Unknowns = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxUnknowns, 1>;
using Gradient = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxWheels, kMaxUnknowns>;

constexpr double kGapTolerance_m = 1e-7;
constexpr double kAcceptedGap_m = 5e-3;  // where the ground's kinks keep Newton from its tolerance
constexpr int kMaxIterations = 25;
constexpr double kLinkageReach_rad = 0.8;  // rockers and bogies turn no further than this

// One equation a wheel: the gap along the ground's normal between rim and ground, and its gradient with
// respect to (z, roll, pitch, joints).
bool linearise(const RoverModel& rover, const Ground& ground, Stance& stance, Gaps& gap, Gradient& gradient) {
  const int joints = joint_count(rover.suspension.type);
  const Eigen::Matrix3d& R = stance.R_MB;
  const Eigen::Vector3d roll_axis = R.col(0);
  const Eigen::Vector3d pitch_axis(-std::sin(stance.attitude.yaw_rad), std::cos(stance.attitude.yaw_rad),
                                   0.0);
  for (std::size_t k = 0; k < rover.wheels.size(); ++k) {
    const Eigen::Vector3d arm = R * stance.p_B_wheel[k];
    const Eigen::Vector3d p_M = stance.p_MB + arm;
    const std::optional<GroundPoint> point = ground.at(p_M.x(), p_M.y());
    if (!point) return false;
    const Eigen::Vector3d& n = point->normal;
    stance.normal_B[k] = R.transpose() * n;
    const Eigen::Index row = static_cast<Eigen::Index>(k);
    gap[row] = (p_M.z() - point->height_m) * n.z() - rover.wheels[k].radius_m;
    gradient(row, 0) = n.z();
    gradient(row, 1) = n.dot(roll_axis.cross(arm));
    gradient(row, 2) = n.dot(pitch_axis.cross(arm));
    for (int joint = 0; joint < joints; ++joint)
      gradient(row, 3 + joint) = stance.normal_B[k].dot(joint_motion(rover, stance, k, joint).shift);
  }
  return true;
}

// Gauss-Newton: where there are as many unknowns as wheels, Newton.
Unknowns newton_step(const Gradient& gradient, const Gaps& gap) {
  if (gradient.rows() == gradient.cols()) return gradient.partialPivLu().solve(-gap);
  return (gradient.transpose() * gradient).ldlt().solve(-(gradient.transpose() * gap));
}

// What a step would still change of the gaps: all of them where the suspension can close them.
double closable_gap_m(const Gradient& gradient, const Gaps& gap, const Unknowns& change) {
  if (gradient.rows() == gradient.cols()) return gap.cwiseAbs().maxCoeff();
  return (gradient * change).cwiseAbs().maxCoeff();
}

void step(const RoverModel& rover, Stance& stance, const Unknowns& change) {
  stance.p_MB.z() += change[0];
  stance.attitude.roll_rad += change[1];
  stance.attitude.pitch_rad += change[2];
  if (change.size() > 3) stance.rocker_rad += change[3];
  if (change.size() > 5) {
    stance.bogie_rad[0] += change[4];
    stance.bogie_rad[1] += change[5];
  }
  stance.R_MB = rotation_MB(stance.attitude);
  place_wheels(rover, stance);
}

// False where a slice has no ground under it. The gap of a slice is the one that linearise() has for the
// wheel, at its place on the axle; what it is less than the wheel's, the ground is higher there.
bool sample_slices(const RoverModel& rover, const Ground& ground, Stance& stance) {
  const Eigen::Vector3d axle = stance.R_MB.col(1);
  stance.slice_height_m = PerWheel<SliceHeights>(rover.wheels.size());
  for (std::size_t k = 0; k < rover.wheels.size(); ++k) {
    const double n_z = (stance.R_MB * stance.normal_B[k]).z();
    const Eigen::Vector3d middle = stance.p_MB + stance.R_MB * stance.p_B_wheel[k];
    for (int s = 0; s < rover.wheel_slices; ++s) {
      const Eigen::Vector3d p_M =
          middle + slice_offset_m(rover.wheels[k].width_m, s, rover.wheel_slices) * axle;
      const std::optional<GroundPoint> point = ground.at(p_M.x(), p_M.y());
      if (!point) return false;
      const double gap = (p_M.z() - point->height_m) * n_z - rover.wheels[k].radius_m;
      stance.slice_height_m[k][s] = stance.gap_m[k] - gap;
    }
  }
  return true;
}

}  // namespace

std::optional<Stance> settle(const RoverModel& rover, const Ground& ground, const Pose2& pose) {
  const std::optional<GroundPoint> under = ground.at(pose.x_m, pose.y_m);
  if (!under) return std::nullopt;
  const Eigen::Index wheels = static_cast<Eigen::Index>(rover.wheels.size());
  const Eigen::Index unknowns = 3 + joint_count(rover.suspension.type);
  Stance stance;
  stance.p_MB = {pose.x_m, pose.y_m, under->height_m};
  stance.attitude.yaw_rad = pose.yaw_rad;
  const double c = std::cos(pose.yaw_rad), s = std::sin(pose.yaw_rad);
  const Eigen::Vector3d& n = under->normal;
  stance.attitude.pitch_rad = std::atan2(c * n.x() + s * n.y(), n.z());
  stance.attitude.roll_rad = std::asin(std::clamp(s * n.x() - c * n.y(), -1.0, 1.0));
  stance.normal_B = PerWheel<Eigen::Vector3d>(rover.wheels.size());
  step(rover, stance, Unknowns::Zero(unknowns));
  Gaps gap(wheels);
  Gradient gradient(wheels, unknowns);
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    if (!linearise(rover, ground, stance, gap, gradient)) return std::nullopt;
    if (gap.cwiseAbs().maxCoeff() < kGapTolerance_m) break;
    Unknowns change = newton_step(gradient, gap);
    if (!change.allFinite()) return std::nullopt;
    if (closable_gap_m(gradient, gap, change) < kGapTolerance_m) break;
    // Past the first steps only the kinks between cells are left: halving the step ends the jumping across
    // them.
    if (iteration > 7) change *= 0.5;
    const double largest = change.tail(unknowns - 1).cwiseAbs().maxCoeff();
    if (largest > 0.3) change *= 0.3 / largest;
    step(rover, stance, change);
  }
  if (!linearise(rover, ground, stance, gap, gradient)) return std::nullopt;
  const double linkage =
      std::max({std::abs(stance.rocker_rad), std::abs(stance.bogie_rad[0]), std::abs(stance.bogie_rad[1])});
  const double left_open = closable_gap_m(gradient, gap, newton_step(gradient, gap));
  if (!(left_open <= kAcceptedGap_m) || linkage > kLinkageReach_rad) return std::nullopt;
  stance.gap_m = PerWheel<double>(rover.wheels.size());
  std::copy(gap.begin(), gap.end(), stance.gap_m.begin());
  if (rover.wheel_slices > 1 && !sample_slices(rover, ground, stance)) return std::nullopt;
  stance.belly_clearance_m = belly_clearance(rover, ground, stance.p_MB, stance.R_MB).least_m;
  return stance;
}

std::optional<Stance> lay_on_fitted_plane(const RoverModel& rover, const Ground& ground, const Pose2& pose) {
  const double c = std::cos(pose.yaw_rad), s = std::sin(pose.yaw_rad);
  // Heights over places in the body's directions: h = a0 + a1 x + a2 y.
  Eigen::Matrix3d normal_matrix = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right_side = Eigen::Vector3d::Zero();
  for (const WheelModel& wheel : rover.wheels) {
    const double x = wheel.position_m.x(), y = wheel.position_m.y();
    const auto point = ground.at(pose.x_m + c * x - s * y, pose.y_m + s * x + c * y);
    if (!point) return std::nullopt;
    const Eigen::Vector3d row(1.0, x, y);
    normal_matrix += row * row.transpose();
    right_side += row * point->height_m;
  }
  const Eigen::Vector3d plane = normal_matrix.ldlt().solve(right_side);
  if (!plane.allFinite()) return std::nullopt;
  Stance stance = stance_on_plane(rover, {.roll_rad = std::atan2(plane[2], std::hypot(1.0, plane[1])),
                                          .pitch_rad = -std::atan(plane[1]),
                                          .yaw_rad = pose.yaw_rad});
  stance.p_MB = {pose.x_m, pose.y_m, plane[0]};
  return stance;
}

Stance stance_on_plane(const RoverModel& rover, const Attitude& attitude) {
  Stance stance;
  stance.attitude = attitude;
  stance.R_MB = rotation_MB(attitude);
  place_wheels(rover, stance);
  stance.normal_B = PerWheel<Eigen::Vector3d>(rover.wheels.size(), Eigen::Vector3d::UnitZ());
  stance.gap_m = PerWheel<double>(rover.wheels.size());
  // Every axle is parallel to the body's xy plane, and so to the ground.
  if (rover.wheel_slices > 1) stance.slice_height_m = PerWheel<SliceHeights>(rover.wheels.size());
  // Over the plane through B's origin. What height and tilt of the body could close of them does not matter.
  for (std::size_t k = 0; k < rover.wheels.size(); ++k)
    stance.gap_m[k] = stance.p_B_wheel[k].z() - rover.wheels[k].radius_m;
  stance.belly_clearance_m = rover.belly_clearance_m;
  return stance;
}

}  // namespace slipway::sim
