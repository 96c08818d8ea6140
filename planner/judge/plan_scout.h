#pragma once

#include <optional>
#include <vector>

#include "planner/problem/route.h"

namespace slipway::planner {

// What the scout drive of the best route (see sim::scout_drive()) would be worth to the choice between the
// routes: the expected value of sample information, in the cost by which routes are ranked on the mean. The
// same draw is the same ground for all of them. Nothing where the best route has no scout drive.
std::optional<PlanScout> scout_of(const std::vector<Route>& routes);

}  // namespace slipway::planner
