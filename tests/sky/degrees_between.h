#pragma once

#include <Eigen/Geometry>
#include <cmath>

#include "core/angle.h"
#include "sky/bearing.h"

namespace slipway::sky {

inline double degrees_between(const Bearing& a, const Bearing& b) {
  const Eigen::Vector3d p = towards(a), q = towards(b);
  return deg_from_rad(std::atan2(p.cross(q).norm(), p.dot(q)));
}

}  // namespace slipway::sky
