#pragma once

#include "planner/problem/problem.h"
#include "planner/search/grid_search.h"

namespace slipway::planner {

// What no way of a leg costs less than, whatever planner finds it and however it is smoothed: turns in place
// are taken to be free, and driving costs what the cheapest way on the cells does in 32 directions, less what
// a way that is bound to these is longer than one that is not: on even ground at most 1 / cos(9.2 deg), half
// of the widest angle between two of them. Of the cells' centres and the leg's ends the way between is left
// out. It holds as far as the ground is even over the length of a step, three cells; 0 where an end can't be
// driven to.
//
// `to_go`: the grid's, to the leg's end.
double least_cost_of_leg(const MotionCost& cost, const CostField& to_go, const Waypoint& from,
                         const Waypoint& to);

}  // namespace slipway::planner
