#include "sim/stance.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

namespace slipway::sim {
namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

constexpr double kGapTolerance_m = 1e-7;
constexpr double kAcceptedGap_m = 5e-3;  // where the ground's kinks keep Newton from its tolerance
constexpr int kMostIterations = 25;
constexpr double kLinkageReach_rad = 0.8;  // rockers and bogies turn no further than this

Eigen::Vector3d mirrored(const Eigen::Vector3d& p) {
  return {p.x(), -p.y(), p.z()};
}

// Wheel centres and bogie pivots in B for given suspension angles.
void place_wheels(const RoverModel& rover, Stance& stance) {
  const Eigen::Vector3d rocker_left = rover.suspension.rocker_pivot_m;
  const Eigen::Vector3d bogie_left = rover.suspension.bogie_pivot_m;
  for (const Side side : {Side::kLeft, Side::kRight}) {
    const bool left = side == Side::kLeft;
    const Eigen::Vector3d rocker = left ? rocker_left : mirrored(rocker_left);
    const Eigen::Vector3d bogie = left ? bogie_left : mirrored(bogie_left);
    const Eigen::AngleAxisd turn_rocker(left ? stance.rocker_rad : -stance.rocker_rad,
                                        Eigen::Vector3d::UnitY());
    const Eigen::AngleAxisd turn_bogie(stance.bogie_rad[left ? 0 : 1], Eigen::Vector3d::UnitY());
    const Eigen::Vector3d pivot = rocker + turn_rocker * (bogie - rocker);
    (left ? stance.p_B_left_bogie : stance.p_B_right_bogie) = pivot;
    for (int k = 0; k < kWheels; ++k) {
      const WheelModel& wheel = rover.wheels[k];
      if (wheel.side != side) continue;
      stance.p_B_wheel[k] =
          wheel.on_bogie ? Eigen::Vector3d(pivot + turn_rocker * (turn_bogie * (wheel.position_m - bogie)))
                         : Eigen::Vector3d(rocker + turn_rocker * (wheel.position_m - rocker));
    }
  }
}

// One Newton equation a wheel: the gap along the ground's normal between rim and ground, and its gradient
// with respect to (z, roll, pitch, rocker, left bogie, right bogie).
bool linearise(const RoverModel& rover, const Ground& ground, Stance& stance, Vector6& gap,
               Matrix6& jacobian) {
  const Eigen::Matrix3d& R = stance.R_MB;
  const Eigen::Vector3d roll_axis = R.col(0);
  const Eigen::Vector3d pitch_axis(-std::sin(stance.attitude.yaw_rad), std::cos(stance.attitude.yaw_rad),
                                   0.0);
  const Eigen::Vector3d pivot_axis = R.col(1);
  for (int k = 0; k < kWheels; ++k) {
    const WheelModel& wheel = rover.wheels[k];
    const bool left = wheel.side == Side::kLeft;
    const Eigen::Vector3d arm = R * stance.p_B_wheel[k];
    const Eigen::Vector3d p_M = stance.p_MB + arm;
    const std::optional<GroundPoint> point = ground.at(p_M.x(), p_M.y());
    if (!point) return false;
    stance.normal_B[k] = R.transpose() * point->normal;
    gap[k] = (p_M.z() - point->height_m) * point->normal.z() - wheel.radius_m;
    const Eigen::Vector3d rocker =
        left ? rover.suspension.rocker_pivot_m : mirrored(rover.suspension.rocker_pivot_m);
    const Eigen::Vector3d bogie = left ? stance.p_B_left_bogie : stance.p_B_right_bogie;
    const Eigen::Vector3d& n = point->normal;
    jacobian(k, 0) = n.z();
    jacobian(k, 1) = n.dot(roll_axis.cross(arm));
    jacobian(k, 2) = n.dot(pitch_axis.cross(arm));
    jacobian(k, 3) = (left ? 1.0 : -1.0) * n.dot(pivot_axis.cross(R * (stance.p_B_wheel[k] - rocker)));
    const double bogie_rate =
        wheel.on_bogie ? n.dot(pivot_axis.cross(R * (stance.p_B_wheel[k] - bogie))) : 0.0;
    jacobian(k, 4) = left ? bogie_rate : 0.0;
    jacobian(k, 5) = left ? 0.0 : bogie_rate;
  }
  return true;
}

void step(const RoverModel& rover, Stance& stance, const Vector6& change) {
  stance.p_MB.z() += change[0];
  stance.attitude.roll_rad += change[1];
  stance.attitude.pitch_rad += change[2];
  stance.rocker_rad += change[3];
  stance.bogie_rad[0] += change[4];
  stance.bogie_rad[1] += change[5];
  stance.R_MB = rotation_MB(stance.attitude);
  place_wheels(rover, stance);
}

// Least height of the belly plane over the ground on a 5 x 5 grid under the body.
double belly_clearance_m(const RoverModel& rover, const Ground& ground, const Stance& stance) {
  double least = std::numeric_limits<double>::infinity();
  const double half_width = 0.5 * (rover.track_m() - rover.wheels.front().width_m);
  for (int i = -2; i <= 2; ++i) {
    for (int j = -2; j <= 2; ++j) {
      const Eigen::Vector3d p_B(0.25 * i * rover.body_length_m, 0.5 * j * half_width,
                                rover.belly_clearance_m);
      const Eigen::Vector3d p_M = stance.p_MB + stance.R_MB * p_B;
      if (const auto point = ground.at(p_M.x(), p_M.y())) least = std::min(least, p_M.z() - point->height_m);
    }
  }
  return least;
}

}  // namespace

std::optional<Stance> settle(const RoverModel& rover, const Ground& ground, const Pose2& pose) {
  const std::optional<GroundPoint> under = ground.at(pose.x_m, pose.y_m);
  if (!under) return std::nullopt;
  Stance stance;
  stance.p_MB = {pose.x_m, pose.y_m, under->height_m};
  stance.attitude.yaw_rad = pose.yaw_rad;
  const double c = std::cos(pose.yaw_rad), s = std::sin(pose.yaw_rad);
  const Eigen::Vector3d& n = under->normal;
  stance.attitude.pitch_rad = std::atan2(c * n.x() + s * n.y(), n.z());
  stance.attitude.roll_rad = std::asin(std::clamp(s * n.x() - c * n.y(), -1.0, 1.0));
  step(rover, stance, Vector6::Zero());
  Vector6 gap;
  Matrix6 jacobian;
  for (int iteration = 0; iteration < kMostIterations; ++iteration) {
    if (!linearise(rover, ground, stance, gap, jacobian)) return std::nullopt;
    if (gap.cwiseAbs().maxCoeff() < kGapTolerance_m) break;
    Vector6 change = jacobian.partialPivLu().solve(-gap);
    if (!change.allFinite()) return std::nullopt;
    // Past the first steps only the kinks between cells are left: halving the step ends the jumping across
    // them.
    if (iteration > 7) change *= 0.5;
    const double largest = change.tail<5>().cwiseAbs().maxCoeff();
    if (largest > 0.3) change *= 0.3 / largest;
    step(rover, stance, change);
  }
  if (!linearise(rover, ground, stance, gap, jacobian)) return std::nullopt;
  const double linkage =
      std::max({std::abs(stance.rocker_rad), std::abs(stance.bogie_rad[0]), std::abs(stance.bogie_rad[1])});
  if (gap.cwiseAbs().maxCoeff() > kAcceptedGap_m || linkage > kLinkageReach_rad) return std::nullopt;
  stance.belly_clearance_m = belly_clearance_m(rover, ground, stance);
  return stance;
}

Stance stance_on_plane(const RoverModel& rover, const Attitude& attitude) {
  Stance stance;
  stance.attitude = attitude;
  stance.R_MB = rotation_MB(attitude);
  place_wheels(rover, stance);
  stance.normal_B.fill(Eigen::Vector3d::UnitZ());
  stance.belly_clearance_m = rover.belly_clearance_m;
  return stance;
}

}  // namespace slipway::sim
