#pragma once

#include <memory>

#include "planner/search/leg_search.h"

namespace slipway::planner {

// The cheapest way on the grid of cells (see GridSearch), pulled straight: of its cells those stay through
// which straights and turns in place cost least, and the last motion may be an arc into the heading of
// arrival. Without random numbers, so that it finds the same for every seed.
std::unique_ptr<LegPlanner> make_grid_planner();

}  // namespace slipway::planner
