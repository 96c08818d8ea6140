#include "planner/search/search_window.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "planner/search/grid_search.h"

namespace slipway::planner {
namespace {

// Which edges of the window have terrain beyond them: west, south, east, north.
std::array<bool, 4> open_edges(const TraverseMap& map, const dem::Terrain& terrain) {
  const dem::Extent window = map.geometry().extent();
  const dem::Extent whole = terrain.geometry().extent();
  const double little = 0.5 * std::min(terrain.geometry().cell_x_m, terrain.geometry().cell_y_m);
  return {window.west_m > whole.west_m + little, window.south_m > whole.south_m + little,
          window.east_m < whole.east_m - little, window.north_m < whole.north_m - little};
}

bool at_edge(const TraverseMap& map, const std::array<bool, 4>& open, const std::vector<std::size_t>& way) {
  const auto columns = static_cast<std::size_t>(map.geometry().columns);
  const auto rows = static_cast<std::size_t>(map.geometry().rows);
  for (const std::size_t cell : way) {
    const std::size_t row = cell / columns, column = cell % columns;
    if ((open[0] && column <= 1) || (open[1] && row + 2 >= rows) || (open[2] && column + 2 >= columns) ||
        (open[3] && row <= 1))
      return true;
  }
  return false;
}

}  // namespace

bool covers(const TraverseMap& map, const dem::Terrain& terrain) {
  for (const bool open : open_edges(map, terrain))
    if (open) return false;
  return true;
}

bool come_to_edge(const PlanProblem& problem, const TraverseMap& map,
                  const std::vector<std::vector<std::size_t>>& ways) {
  constexpr double kNear_cells = 4.0;
  const dem::Extent edge = problem.terrain->geometry().extent();
  const double near_m = 0.5 * std::hypot(problem.rover->body_length_m, problem.rover->body_width_m) +
                        kNear_cells * std::max(map.geometry().cell_x_m, map.geometry().cell_y_m);
  for (const std::vector<std::size_t>& way : ways) {
    for (const std::size_t cell : way) {
      const Eigen::Vector2d at = map.centre_m(cell);
      if (at.x() < edge.west_m + near_m || at.x() > edge.east_m - near_m || at.y() < edge.south_m + near_m ||
          at.y() > edge.north_m - near_m)
        return true;
    }
  }
  return false;
}

WindowFit window_fit(const PlanProblem& problem, const TraverseMap& map, const GroundTables& tables) {
  const MotionCost cost(problem, map, tables, problem.weights);
  const GridSearch grid(cost);
  const std::array<bool, 4> open = open_edges(map, *problem.terrain);
  const std::vector<Waypoint> places = problem.places();
  bool edge = false;
  for (std::size_t leg = 0; leg + 1 < places.size(); ++leg) {
    const Waypoint &from = places[leg], &to = places[leg + 1];
    const std::vector<std::size_t> way = grid.way(grid.cost_to_go(to.x_m, to.y_m), from.x_m, from.y_m);
    if (way.empty()) return WindowFit::kNoWay;
    edge |= at_edge(map, open, way);
  }
  return edge ? WindowFit::kAtEdge : WindowFit::kInside;
}

}  // namespace slipway::planner
