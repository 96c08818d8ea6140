#include "sim/dynamic/rut_trail.h"

#include <algorithm>

namespace slipway::sim {

void RutTrail::move_to(const Eigen::Vector2d& place, double depth_m, double width_m, double clear_m,
                       RutMap& ruts) {
  if (!points_.empty() && (points_.back().place - place).norm() < 0.5 * ruts.cell_m()) {
    points_.back().depth_m = std::max(points_.back().depth_m, depth_m);
    return;
  }
  points_.push_back({place, depth_m});
  std::size_t left = 0;
  for (; left + 1 < points_.size() && (points_[left + 1].place - place).norm() > clear_m; ++left)
    ruts.press(points_[left].place, points_[left + 1].place, width_m,
               std::max(points_[left].depth_m, points_[left + 1].depth_m));
  points_.erase(points_.begin(), points_.begin() + static_cast<std::ptrdiff_t>(left));
}

}  // namespace slipway::sim
