#pragma once

#include <memory>

#include "planner/search/leg_search.h"

namespace slipway::planner {

// The planners of OMPL. Its headers stay in planner/search/ompl_*.cc.
std::unique_ptr<LegPlanner> make_rrt_star();
std::unique_ptr<LegPlanner> make_bit_star();

}  // namespace slipway::planner
