#pragma once

#include <span>
#include <vector>

#include "core/pose.h"
#include "planner/problem/problem.h"
#include "sim/rover/rover_model.h"

namespace slipway::planner {

// The polygons that the rover's body must stay out of. A polygon that crosses itself encloses what an odd
// number of its edges surrounds.
class KeepOut {
 public:
  KeepOut(std::span<const Polygon> polygons, const sim::RoverModel& rover);

  bool empty() const { return polygons_.empty(); }
  // The body's rectangle meets a polygon.
  bool hits(const Pose2& pose) const;
  // The polygon that holds the point or is nearer to it than the body's half width or half length, whichever
  // is less: then the body meets it at any heading.
  bool hits_at_any_heading(double x_m, double y_m) const { return distance_m(x_m, y_m) <= inscribed_m_; }
  // The body meets no polygon at any heading.
  bool clear_at_any_heading(double x_m, double y_m) const { return distance_m(x_m, y_m) > circumscribed_m_; }

 private:
  // To the nearest polygon; 0 inside one.
  double distance_m(double x_m, double y_m) const;

  std::vector<Polygon> polygons_;
  double half_length_m_;
  double half_width_m_;
  double inscribed_m_;
  double circumscribed_m_;
};

}  // namespace slipway::planner
