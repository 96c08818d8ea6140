#pragma once

#include <optional>
#include <string>

#include "planner/search/motion_cost.h"

namespace slipway::planner {

// What closes every way between two places of a map without a way, as a sentence: of all ways on the grid the
// one whose worst breach of a limit is least, the place of that breach, and what would open the way.
//
// Breaches in their order: a slope on which the mean soil holds no rover, by its share of the tilt limit;
// tilt and the ground's rise under the belly, by their ratio to the limit; a keep-out; missing elevation. A
// change of limits is only offered where a search with it finds a way. Nothing where a place is off the map.
std::optional<std::string> bottleneck(const PlanProblem& problem, const MotionCost& cost,
                                      const Waypoint& from, const Waypoint& to);

// Which zone of the problem keeps the rover's body off a way over the grid's cells, and where: a sentence
// with the zone's place in the request and the distance from the way's beginning. Nothing where none does.
std::optional<std::string> zone_on_way(const PlanProblem& problem, const TraverseMap& map,
                                       const std::vector<std::size_t>& way);

// The first place along the motions that the search does not allow, and why: a sentence. Nothing where all is
// allowed.
std::optional<std::string> first_closed(const PlanProblem& problem, const MotionCost& cost,
                                        const std::vector<Motion>& motions);

}  // namespace slipway::planner
