#pragma once

#include <optional>
#include <string>
#include <vector>

#include "planner/problem/motion.h"
#include "planner/search/traverse_map.h"

namespace slipway::planner {

// The narrowest gap that a route passes, if every way between the route's ends passes it: found by measuring
// the open cells on both sides across the route, and proven by closing the gap on the map and finding no way
// left. A sentence with width and place, or nothing where the gap can be driven around.
std::optional<std::string> only_way(const TraverseMap& map, const std::vector<Motion>& route);

// Where a way over the grid's cells, in their order and at least one, is steepest and narrowest: a sentence.
std::string hardest_place(const TraverseMap& map, const std::vector<std::size_t>& way);

// Why there is no way: what closes cells around the region that can be reached from the start, in words and
// numbers.
std::string no_way(const TraverseMap& map, double start_x_m, double start_y_m, double goal_x_m,
                   double goal_y_m);

}  // namespace slipway::planner
