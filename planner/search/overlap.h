#pragma once

#include <Eigen/Core>
#include <vector>

#include "planner/problem/motion.h"

namespace slipway::planner {

// A route's centreline as places at most spacing_m apart, in driving order.
std::vector<Eigen::Vector2d> centreline(const std::vector<Motion>& motions, double spacing_m);

// The share of line a's length that lies within width_m of line b, in [0, 1]. Both lines are densely sampled
// centrelines (their spacing well below the width). Not symmetric: a short route can lie within a long one.
double overlap(const std::vector<Eigen::Vector2d>& a, const std::vector<Eigen::Vector2d>& b, double width_m);

}  // namespace slipway::planner
