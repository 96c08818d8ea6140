#pragma once

#include <Eigen/Core>
#include <array>

#include "sim/quasi_static/quasi_static.h"
#include "sim/wheel/per_wheel.h"

namespace slipway::sim {

// The true state of the rover at an instant.
struct DriveSample {
  double time_s = 0.0;
  Eigen::Vector3d p_MB = Eigen::Vector3d::Zero();
  Attitude attitude;                                         // yaw is not wrapped
  Eigen::Vector3d velocity_B = Eigen::Vector3d::Zero();      // of B's origin, m/s
  Eigen::Vector3d angular_rate_B = Eigen::Vector3d::Zero();  // as a gyroscope on the body measures it, rad/s
  Eigen::Vector3d specific_force_B =
      Eigen::Vector3d::Zero();                      // as an accelerometer at B's origin measures it, m/s^2
  std::array<double, 2> rocker_rad{}, bogie_rad{};  // left, right; 0 where there are none
  PerWheel<WheelState> wheels;  // sinkage and slip as in WheelState; loads along the ground's normal
  PerWheel<double> steer_rad;
  PerWheel<double> commanded_rate_rad_s;  // at the wheel
  PerWheel<double> turned_rad;            // angle of each wheel since the start, as an encoder counts it
  PerWheel<double> voltage_v;             // at the drive motors
  double slip_ratio = 0.0;                // of the rover at that instant: 1 - speed / commanded speed
  double progress_m = 0.0;  // of B along the legs' lines since the start; turning in place adds none
  int leg = 0;
  bool driving = false;  // false while the rover halts, where slip_ratio has no meaning
};

}  // namespace slipway::sim
