#pragma once

#include <vector>

#include "planner/problem/problem.h"
#include "planner/search/ground_tables.h"
#include "planner/search/traverse_map.h"

namespace slipway::planner {

// How the grid's best ways through all places, under the request's own weights, lie in the map's window.
enum class WindowFit {
  kInside,  // none comes to an edge of the window
  kAtEdge,  // one does, so that there may be a better one outside; the terrain's own edge is no such edge
  kNoWay,   // between two places there is no way in the window
};

WindowFit window_fit(const PlanProblem& problem, const TraverseMap& map, const GroundTables& tables);

// One of these ways on the map's cells comes so near to the terrain's edge that a better one may lie beyond:
// within a few cells of where the rover may stand no more.
bool come_to_edge(const PlanProblem& problem, const TraverseMap& map,
                  const std::vector<std::vector<std::size_t>>& ways);

// The map's window holds the whole terrain.
bool covers(const TraverseMap& map, const dem::Terrain& terrain);

}  // namespace slipway::planner
