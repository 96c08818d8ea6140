#pragma once

#include <optional>
#include <vector>

#include "core/progress.h"
#include "core/result.h"
#include "dem/grid_geometry.h"
#include "planner/problem/problem.h"

namespace slipway::planner {

// What a rover may use up on its way.
struct WayBudget {
  std::optional<double> energy_j = {};  // of the drive motors
  // Each has `driving_hours_per_sol` of driving, and a stop costs the rest of one.
  std::optional<double> sols = {};
  double driving_hours_per_sol = 4.0;
};

// A raster in memory, row by row.
struct WayMap {
  dem::GridGeometry geometry;
  std::vector<float> values;
};

// More cells than this no map of ways has: a terrain with more of the finest cells gets larger ones, in whole
// numbers of the terrain's, which allow what the worst of the ground in them does. At some 70 bytes each,
// searched by one thread.
constexpr long long kMaxWayCells = 16'000'000;

// The cost of the cheapest way on the search's grid from each of its cells to the place, under the problem's
// weights; kNoMapValue where there is none. Errors: invalid_request at `pointer` where the rover may not
// stand at the place; cancelled.
Result<WayMap> cost_to_go_map(const PlanProblem& problem, const Waypoint& place, const char* pointer,
                              Progress& progress);

// Which cells the rover comes to from the place within the budget, as map_class values: by the way that uses
// up the least share of the budget on the grid, with what Metre says of each metre of it summed. Errors: as
// above.
Result<WayMap> reachable_map(const PlanProblem& problem, const Waypoint& place, const WayBudget& budget,
                             const char* pointer, Progress& progress);

}  // namespace slipway::planner
