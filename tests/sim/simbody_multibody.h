#pragma once

#include <memory>
#include <vector>

#include "sim/dynamic/multibody.h"

namespace slipway::sim {

// A state of a multibody and what acts on it, in MultibodyDynamics's own terms.
struct LoadedState {
  Eigen::Matrix3d R_MB = Eigen::Matrix3d::Identity();
  SpatialVector base = SpatialVector::Zero();
  Eigen::VectorXd angles_rad, rates_rad_s, torques_nm;
  struct Force {
    int body = -1;
    Eigen::Vector3d p_B, force_B, moment_B;
  };
  std::vector<Force> forces;
  Eigen::Vector3d gravity_M = Eigen::Vector3d::Zero();
};

struct Accelerations {
  SpatialVector base = SpatialVector::Zero();
  Eigen::VectorXd joints;
};

// The same tree in Simbody [Sherman, Seth and Delp 2011], which knows no armature.
class SimbodyMultibody {
 public:
  explicit SimbodyMultibody(const Multibody& multibody);
  ~SimbodyMultibody();

  Accelerations accelerations(const LoadedState& loaded);

 private:
  struct System;
  std::unique_ptr<System> system_;
};

}  // namespace slipway::sim
