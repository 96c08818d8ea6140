#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace slipway {

// Position and heading of the body frame B in the map frame M. The yaw is counter-clockwise from map east.
struct Pose2 {
  double x_m = 0.0;
  double y_m = 0.0;
  double yaw_rad = 0.0;

  bool operator==(const Pose2&) const = default;
};

// R_MB = Rz(yaw) Ry(pitch) Rx(roll): positive pitch is nose down, positive roll is left side up.
struct Attitude {
  double roll_rad = 0.0;
  double pitch_rad = 0.0;
  double yaw_rad = 0.0;

  // Angle between the body's z axis and the vertical.
  double tilt_rad() const { return std::acos(std::cos(roll_rad) * std::cos(pitch_rad)); }
};

inline Eigen::Matrix3d rotation_MB(const Attitude& a) {
  return (Eigen::AngleAxisd(a.yaw_rad, Eigen::Vector3d::UnitZ()) *
          Eigen::AngleAxisd(a.pitch_rad, Eigen::Vector3d::UnitY()) *
          Eigen::AngleAxisd(a.roll_rad, Eigen::Vector3d::UnitX()))
      .toRotationMatrix();
}

// The inverse of rotation_MB(), for pitch angles within a quarter turn.
inline Attitude attitude_of(const Eigen::Matrix3d& R_MB) {
  return {.roll_rad = std::atan2(R_MB(2, 1), R_MB(2, 2)),
          .pitch_rad = std::asin(std::clamp(-R_MB(2, 0), -1.0, 1.0)),
          .yaw_rad = std::atan2(R_MB(1, 0), R_MB(0, 0))};
}

}  // namespace slipway
