#pragma once

#include <Eigen/Core>

#include "sim/wheel/per_wheel.h"

namespace slipway::sim {

// What acts on a vehicle besides its weight and the ground: a tether, a push, a cable that a wheel drags. In
// frame B; N and N m.
struct OutsideWrench {
  Eigen::Vector3d force_n = Eigen::Vector3d::Zero();    // on the body
  Eigen::Vector3d moment_nm = Eigen::Vector3d::Zero();  // of all that acts on the body, about B's origin
  PerWheel<Eigen::Vector3d> at_wheel_n;                 // at each wheel's axle; empty: none
};

}  // namespace slipway::sim
