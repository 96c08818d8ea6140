#pragma once

#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "core/pose.h"
#include "planner/problem/motion.h"
#include "planner/problem/problem.h"
#include "sim/rover/rover_model.h"

namespace slipway::planner {

// From p to the nearest point of the segment from a to b.
double distance_to_segment_m(const Eigen::Vector2d& p, const Eigen::Vector2d& a, const Eigen::Vector2d& b);

// The polygons that the rover's body, a rectangle about its pose, must stay out of, and those that it must
// stay in: of each of these it must stay out of all that is outside. Polygons and body are closed: to touch
// an edge is to hit. A polygon that crosses itself encloses what an odd number of its edges surrounds.
class KeepOut {
 public:
  KeepOut(std::span<const Polygon> polygons, const sim::RoverModel& rover,
          std::span<const Polygon> keep_in = {});

  bool empty() const { return zones_.empty(); }
  // The body's rectangle meets a polygon, or is not wholly in one that it must stay in.
  bool hits(const Pose2& pose) const;
  // The body meets a zone anywhere along the motion, both turns in place included. Exact, not sampled:
  // what a rectangle sweeps when it is shifted is a rectangle, and a rectangle that is turned about a point
  // meets a zone first where a corner of the one crosses an edge of the other, on a circle about that
  // point.
  bool hits_along(const Motion& motion) const;
  // Where hits_along(motion) holds: the first pose, to `step_m` along the drive and half a degree in a turn,
  // at which the body is inside; the motion's end where none of these is. Nothing where the motion is clear.
  std::optional<Pose2> first_hit(const Motion& motion, double step_m = 0.05) const;
  // The body meets a zone at every heading: one holds the point or is nearer to it than the body's half
  // width or half length, whichever is less.
  bool hits_at_any_heading(double x_m, double y_m) const { return within(x_m, y_m, inscribed_m_); }
  // The body meets no zone at any heading, wherever it stands within `reach_m` of the point.
  bool clear_at_any_heading(double x_m, double y_m, double reach_m = 0.0) const {
    return !within(x_m, y_m, circumscribed_m_ + reach_m);
  }

 private:
  // What a polygon closes to the body: its inside, or all that is outside.
  struct Zone {
    Polygon polygon;
    Eigen::Vector2d low, high;  // its bounding box
    bool closes_outside = false;

    bool box_within(const Eigen::Vector2d& point, double distance_m) const;
    bool holds(const Eigen::Vector2d& point) const;
    // Meets the rectangle of these half sides about the pose.
    bool meets_rectangle(const Pose2& pose, const Eigen::Vector2d& half) const;
  };

  void add(const Polygon& polygon, bool closes_outside);
  // A zone holds the point or is at most so far from it.
  bool within(double x_m, double y_m, double distance_m) const;
  bool turning_hits(const Zone& zone, const Pose2& from, const Eigen::Vector2d& centre_in_body,
                    double turn_rad) const;
  bool driving_hits(const Zone& zone, const Motion& motion) const;

  std::vector<Zone> zones_;
  Eigen::Vector2d half_;  // of the body, along and across
  double inscribed_m_;
  double circumscribed_m_;
};

// What a body does that hits a zone of the problem: "enter a keep-out", "leave a keep-in" or either.
std::string_view trespass_in_words(const PlanProblem& problem);

// Of a route's motions in their order.
std::optional<Pose2> first_hit(const KeepOut& keep_out, std::span<const Motion> motions);

}  // namespace slipway::planner
