#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "planner/search/motion_cost.h"

namespace slipway::planner {

// A step of the grid in cells.
struct GridStep {
  int right, up;
};

constexpr int kGridSteps = 16;
constexpr int opposite(int step) {
  return (step + kGridSteps / 2) % kGridSteps;
}
// Counter-clockwise from east.
constexpr std::array<GridStep, kGridSteps> kGridDirections{{{1, 0},
                                                            {2, 1},
                                                            {1, 1},
                                                            {1, 2},
                                                            {0, 1},
                                                            {-1, 2},
                                                            {-1, 1},
                                                            {-2, 1},
                                                            {-1, 0},
                                                            {-2, -1},
                                                            {-1, -1},
                                                            {-1, -2},
                                                            {0, -1},
                                                            {1, -2},
                                                            {1, -1},
                                                            {2, -1}}};

// The cell that a step leads to from another; -1 off the map.
inline long long cell_beyond(const TraverseMap& map, const dem::Cell& from, int step) {
  const GridStep& s = kGridDirections[static_cast<std::size_t>(step)];
  return map.index_of(from.row - s.up, from.column + s.right);
}

// Cost of the cheapest way on the grid between one place and every cell, and the way itself.
struct CostField {
  std::vector<float> cost;         // infinite where there is no way
  std::vector<std::int16_t> step;  // towards the next cell on the way to (from) the place; -1 there
};

// When a field needs to go no further.
struct SpreadEnd {
  long long at_cell = -1;           // where its cost is known; -1: nowhere
  std::function<bool()> cancelled;  // then the field is of no use
};

// Dijkstra over the map's cells and 16 directions (eight neighbours and eight knight's moves), each edge
// costing what the motion cost says of driving in that direction; turns in place are free here. It shows with
// certainty whether a goal can be reached on the grid, its optimum is a yardstick for the routes that
// planners find, and its fields show their samplers where good routes run.
class GridSearch {
 public:
  // On a map of blocks, or of more than kMaxSearchCells, it keeps a reference to `cost`, which it asks anew
  // for every step: their cells are many, and keeping 16 costs of each would take three times the memory of
  // the rest and no less time.
  explicit GridSearch(const MotionCost& cost);

  // Driving to the place from every cell.
  CostField cost_to_go(double x_m, double y_m, const SpreadEnd& end = {}) const {
    return spread(x_m, y_m, true, end);
  }
  // Driving from the place to every cell.
  CostField cost_to_come(double x_m, double y_m, const SpreadEnd& end = {}) const {
    return spread(x_m, y_m, false, end);
  }
  // The cells from the one at (x, y) to the place that a cost-to-go belongs to. Empty where there is no way.
  std::vector<std::size_t> way(const CostField& to_go, double x_m, double y_m) const;
  // The heading of a step.
  static double heading_rad(int step);
  // The same as a vector of length 1.
  static const Eigen::Vector2d& direction(int step);
  // Of a metre in a cell in a direction, of which the heading is the same; infinite where the body may not
  // stand so at its centre.
  static double per_metre_in(const MotionCost& cost, std::size_t cell, double heading_rad,
                             const Eigen::Vector2d& direction);
  // Half the length of each step.
  static std::array<float, kGridSteps> half_lengths_m(const dem::GridGeometry& geometry);

 private:
  CostField spread(double x_m, double y_m, bool to_go, const SpreadEnd& end) const;
  bool passes_corners(const dem::Cell& from, int step, int driven) const;
  // Of the body driven straight from the cell's centre by the step, or back: it covers the same ground.
  bool clear_of_keep_outs(const dem::Cell& from, int step) const;

  static float found_per_metre(const MotionCost& cost, std::size_t cell, int step) {
    return static_cast<float>(per_metre_in(cost, cell, heading_rad(step), direction(step)));
  }
  float per_metre(std::size_t cell, int step) const {
    return cost_ ? found_per_metre(*cost_, cell, step)
                 : per_metre_[cell * static_cast<std::size_t>(kGridSteps) + static_cast<std::size_t>(step)];
  }

  const TraverseMap& map_;
  const MotionCost* cost_ = nullptr;    // of a map of many cells
  std::unique_ptr<float[]> per_metre_;  // of any other: of each cell and direction
};

// What a way from cell to cell costs, step by step as the grid's steps do.
double cost_of_way(const MotionCost& cost, const std::vector<std::size_t>& way);

}  // namespace slipway::planner
