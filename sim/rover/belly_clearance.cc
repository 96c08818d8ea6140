#include "sim/rover/belly_clearance.h"

#include <limits>

namespace slipway::sim {

BellyClearance belly_clearance(const RoverModel& rover, const Ground& ground, const Eigen::Vector3d& p_MB,
                               const Eigen::Matrix3d& R_MB) {
  BellyClearance clearance{std::numeric_limits<double>::infinity()};
  const double half_width = 0.5 * (rover.track_m() - rover.wheels.front().width_m);
  for (int i = -2; i <= 2; ++i) {
    for (int j = -2; j <= 2; ++j) {
      const Eigen::Vector3d p_B(0.25 * i * rover.body_length_m, 0.5 * j * half_width,
                                rover.belly_clearance_m);
      const Eigen::Vector3d p_M = p_MB + R_MB * p_B;
      const auto point = ground.at(p_M.x(), p_M.y());
      if (point && p_M.z() - point->height_m < clearance.least_m)
        clearance = {p_M.z() - point->height_m, p_M.head<2>()};
    }
  }
  return clearance;
}

}  // namespace slipway::sim
