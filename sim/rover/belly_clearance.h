#pragma once

#include <Eigen/Core>

#include "sim/rover/ground.h"
#include "sim/rover/rover_model.h"

namespace slipway::sim {

struct BellyClearance {
  double least_m = 0.0;  // of the belly plane over the ground under the body; infinite without any ground
  Eigen::Vector2d place = Eigen::Vector2d::Zero();  // where that is
};

// On a 5 x 5 grid under the body of a rover that stands so.
BellyClearance belly_clearance(const RoverModel& rover, const Ground& ground, const Eigen::Vector3d& p_MB,
                               const Eigen::Matrix3d& R_MB);

}  // namespace slipway::sim
