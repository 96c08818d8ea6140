#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "core/progress.h"
#include "planner/problem/motion.h"
#include "planner/search/overlap.h"

namespace slipway::planner {

// Tells who waits of the best route so far.
inline void tell_found(Progress& progress, const std::vector<Motion>& motions, double cost,
                       std::string_view verdict = {}) {
  constexpr double kPlaces = 200.0;
  RouteSoFar route{.cost = cost, .length_m = 0.0, .verdict = std::string(verdict), .line_m = {}};
  for (const Motion& motion : motions) route.length_m += motion.length_m;
  const double spacing = std::max(1.0, route.length_m / kPlaces);
  double left = 0.0;
  for (const Eigen::Vector2d& p : centreline(motions, 0.25 * spacing)) {
    // Every fourth place or so: centreline() begins anew with each motion.
    if (!route.line_m.empty()) {
      const auto& [x, y] = route.line_m.back();
      left = std::hypot(p.x() - x, p.y() - y);
    }
    if (route.line_m.empty() || left >= spacing) route.line_m.push_back({p.x(), p.y()});
  }
  if (!motions.empty()) route.line_m.push_back({motions.back().to.x_m, motions.back().to.y_m});
  progress.found(route);
}

}  // namespace slipway::planner
