#pragma once

#include "planner/problem/problem.h"
#include "planner/search/grid_search.h"

namespace slipway::planner {

// What no way of a leg costs less than, whatever planner finds it and however it is smoothed: turns in place
// are taken to be free, and driving costs what the cheapest way from centre to centre of the cells does in 32
// directions, less what a way that is bound to these is longer than one that is not: at most 1 / cos(9.2
// deg), half of the widest angle between two of them. What lies between a centre and the leg's end is left
// out. It holds as far as a way gains nothing by turning within cells; 0 where there is no way.
//
// `to_go`: the grid's, to the leg's end.
double least_cost_of_leg(const MotionCost& cost, const CostField& to_go, const Waypoint& from,
                         const Waypoint& to);

}  // namespace slipway::planner
