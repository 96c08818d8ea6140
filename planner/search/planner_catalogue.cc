#include "planner/search/planner_catalogue.h"

#include <algorithm>
#include <array>

#include "planner/search/grid_leg_planner.h"
#include "planner/search/ompl_leg_planners.h"

namespace slipway::planner {

std::span<const PlannerRow> planner_catalogue() {
  static constexpr std::array<PlannerRow, 3> kRows{{
      {"rrt_star", "RRT*: a tree rewired around every new sample", "Karaman and Frazzoli 2011", true,
       make_rrt_star},
      {"bit_star", "BIT*: batches of samples, their edges searched in the order of cost",
       "Gammell, Srinivasa and Barfoot 2015", true, make_bit_star},
      {"grid", "Dijkstra on the search's cells, its way pulled straight; without random numbers",
       "Dijkstra 1959", false, make_grid_planner},
  }};
  return kRows;
}

const PlannerRow* planner_named(std::string_view name, std::span<const PlannerRow> rows) {
  const auto row =
      std::find_if(rows.begin(), rows.end(), [&](const PlannerRow& r) { return r.name == name; });
  return row == rows.end() ? nullptr : &*row;
}

}  // namespace slipway::planner
