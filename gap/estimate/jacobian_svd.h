#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "gap/estimate/least_squares.h"

namespace slipway::gap {

struct JacobianSvd {
  Eigen::MatrixXd covariance;  // sum over determined directions of v v^T / s^2, in the unknowns' units
  std::vector<UndeterminedDirection> undetermined;
};

// The covariance (J^T J)^-1 of unknowns by J = U S V^T, with columns scaled by `scale` first so that what
// counts as small does not depend on units. Directions below rank_tolerance of the largest singular value are
// listed, not inverted; a Jacobian of zeros determines nothing.
JacobianSvd covariance_by_svd(const Eigen::MatrixXd& jacobian, const Eigen::VectorXd& scale,
                              const std::vector<std::string>& names, double rank_tolerance);

}  // namespace slipway::gap
