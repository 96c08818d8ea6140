#pragma once

#include <Eigen/Core>
#include <vector>

#include "sim/dynamic/rut_map.h"

namespace slipway::sim {

// What one wheel has left behind but is still near to. Its track is pressed into the map only once the wheel
// has left it, so that it never meets the rut that it stands in.
class RutTrail {
 public:
  // The wheel is at a place now, pressed to a depth below the undisturbed surface; its track behind it is
  // pressed where it is farther than `clear_m`.
  void move_to(const Eigen::Vector2d& place, double depth_m, double width_m, double clear_m, RutMap& ruts);

 private:
  struct Point {
    Eigen::Vector2d place;
    double depth_m = 0.0;
  };
  std::vector<Point> points_;  // oldest first
};

}  // namespace slipway::sim
