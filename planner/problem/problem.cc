#include "planner/problem/problem.h"

#include <algorithm>
#include <cmath>

#include "core/angle.h"

namespace slipway::planner {

double Manner::body_yaw(double travel_rad) const {
  return wrapped_rad(travel_rad - crab_rad + (backwards ? M_PI : 0.0));
}

std::vector<Waypoint> PlanProblem::places() const {
  std::vector<Waypoint> all{start};
  all.insert(all.end(), waypoints.begin(), waypoints.end());
  all.push_back(goal);
  return all;
}

std::vector<double> PlanProblem::leg_lengths_m() const {
  const std::vector<Waypoint> all = places();
  std::vector<double> lengths;
  for (std::size_t i = 1; i < all.size(); ++i)
    lengths.push_back(std::hypot(all[i].x_m - all[i - 1].x_m, all[i].y_m - all[i - 1].y_m));
  return lengths;
}

double PlanProblem::max_tilt_rad() const {
  return std::min(limits.max_tilt_rad, rover->max_tilt_rad);
}

double Manner::travel(double body_yaw_rad) const {
  return wrapped_rad(body_yaw_rad + crab_rad - (backwards ? M_PI : 0.0));
}

}  // namespace slipway::planner
