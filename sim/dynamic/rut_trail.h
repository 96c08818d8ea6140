#pragma once

#include <Eigen/Core>
#include <vector>

#include "sim/dynamic/rut_map.h"

namespace slipway::sim {

// The part of one wheel's track that is still near the wheel. A track is pressed into the map only once the
// wheel has left it, so that a wheel never meets the rut in which it stands.
class RutTrail {
 public:
  // Records that the wheel is at this place now, at this depth below the undisturbed surface, and presses the
  // parts of its track that are farther away than clear_m.
  void move_to(const Eigen::Vector2d& place, double depth_m, double width_m, double clear_m, RutMap& ruts);

 private:
  struct Point {
    Eigen::Vector2d place;
    double depth_m = 0.0;
  };
  std::vector<Point> points_;  // oldest first
};

}  // namespace slipway::sim
