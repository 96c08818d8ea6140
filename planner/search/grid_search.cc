#include "planner/search/grid_search.h"

#include <array>
#include <cmath>
#include <limits>
#include <queue>

namespace slipway::planner {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

struct Step {
  int right, up;
};

// Counter-clockwise from east; the opposite of step k is k + 8.
constexpr std::array<Step, kGridSteps> kSteps{{{1, 0},
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

int opposite(int step) {
  return (step + kGridSteps / 2) % kGridSteps;
}

struct Reached {
  float cost;
  std::uint32_t cell;
  // Ties by cell, so that the order is one order.
  bool operator>(const Reached& other) const {
    return cost > other.cost || (cost == other.cost && cell > other.cell);
  }
};

}  // namespace

double GridSearch::heading_rad(int step) {
  return std::atan2(kSteps[static_cast<std::size_t>(step)].up, kSteps[static_cast<std::size_t>(step)].right);
}

GridSearch::GridSearch(const MotionCost& cost) : map_(cost.map()), per_metre_(map_.cells() * kGridSteps) {
  std::array<Eigen::Vector2d, kGridSteps> direction;
  for (int k = 0; k < kGridSteps; ++k) direction[k] = {std::cos(heading_rad(k)), std::sin(heading_rad(k))};
  for (std::size_t i = 0; i < map_.cells(); ++i) {
    const Passage passage = map_.cell(i).passage;
    const Eigen::Vector2d centre = map_.centre_m(i);
    for (int k = 0; k < kGridSteps; ++k) {
      const bool open =
          passage == Passage::kFree ||
          (passage == Passage::kNearKeepOut && map_.may_stand({centre.x(), centre.y(), heading_rad(k)}));
      per_metre_[i * kGridSteps + k] =
          open ? static_cast<float>(cost.per_metre_in_cell(i, direction[k].x(), direction[k].y()))
               : kInfinity;
    }
  }
}

bool GridSearch::passes_corners(std::size_t row, std::size_t column, int step, int driven) const {
  // A knight's move runs between two cells: both must be open in the direction that is driven.
  const Step& s = kSteps[static_cast<std::size_t>(step)];
  if (std::abs(s.right) + std::abs(s.up) != 3) return true;
  const auto columns = static_cast<std::size_t>(map_.geometry().columns);
  const int half_right = s.right / 2;
  const int half_up = s.up / 2;
  const std::size_t first = (row - half_up) * columns + (column + half_right);
  const std::size_t second = (row - (s.up - half_up)) * columns + (column + (s.right - half_right));
  return per_metre_[first * kGridSteps + driven] < kInfinity &&
         per_metre_[second * kGridSteps + driven] < kInfinity;
}

bool GridSearch::clear_of_keep_outs(std::size_t row, std::size_t column, int step) const {
  const Step& s = kSteps[static_cast<std::size_t>(step)];
  const auto columns = static_cast<std::size_t>(map_.geometry().columns);
  // A step runs within the rectangle of cells between its ends; free ones are clear wherever the body stands.
  bool near = false;
  for (int up = std::min(0, s.up); up <= std::max(0, s.up); ++up)
    for (int right = std::min(0, s.right); right <= std::max(0, s.right); ++right)
      near |= map_.cell((row - up) * columns + (column + right)).passage != Passage::kFree;
  if (!near) return true;
  const Eigen::Vector2d from = map_.centre_m(row * columns + column);
  const Eigen::Vector2d to = map_.centre_m((row - s.up) * columns + (column + s.right));
  const double bearing = std::atan2(to.y() - from.y(), to.x() - from.x());
  return !map_.keep_out().hits_along(straight({from.x(), from.y(), bearing}, to.x(), to.y()));
}

CostField GridSearch::spread(double x_m, double y_m, bool to_go) const {
  CostField field{.cost = std::vector<float>(map_.cells(), kInfinity),
                  .step = std::vector<std::int16_t>(map_.cells(), -1)};
  const long long origin = map_.index_at(x_m, y_m);
  if (origin < 0) return field;
  const dem::GridGeometry& g = map_.geometry();
  const auto columns = static_cast<std::size_t>(g.columns);
  std::array<float, kGridSteps> half_length;
  for (int k = 0; k < kGridSteps; ++k) {
    half_length[k] =
        0.5F * static_cast<float>(std::hypot(kSteps[k].right * g.cell_x_m, kSteps[k].up * g.cell_y_m));
  }
  std::priority_queue<Reached, std::vector<Reached>, std::greater<>> open;
  field.cost[static_cast<std::size_t>(origin)] = 0.0F;
  open.push({0.0F, static_cast<std::uint32_t>(origin)});
  while (!open.empty()) {
    const Reached here = open.top();
    open.pop();
    if (here.cost > field.cost[here.cell]) continue;
    const std::size_t row = here.cell / columns;
    const std::size_t column = here.cell % columns;
    for (int k = 0; k < kGridSteps; ++k) {
      // k is the direction away from the origin; the rover drives it, or its opposite on the way to a goal.
      const int driven = to_go ? opposite(k) : k;
      const float half = per_metre_[here.cell * kGridSteps + driven];
      const long long next_row = static_cast<long long>(row) - kSteps[k].up;
      const long long next_column = static_cast<long long>(column) + kSteps[k].right;
      if (!(half < kInfinity) || next_row < 0 || next_column < 0 || next_row >= g.rows ||
          next_column >= g.columns)
        continue;
      const auto next = static_cast<std::size_t>(next_row) * columns + static_cast<std::size_t>(next_column);
      const float cost = here.cost + half_length[k] * (half + per_metre_[next * kGridSteps + driven]);
      if (!(cost < field.cost[next]) || !passes_corners(row, column, k, driven) ||
          !clear_of_keep_outs(row, column, k))
        continue;
      field.cost[next] = cost;
      field.step[next] = static_cast<std::int16_t>(driven);
      open.push({cost, static_cast<std::uint32_t>(next)});
    }
  }
  return field;
}

std::vector<std::size_t> GridSearch::way(const CostField& to_go, double x_m, double y_m) const {
  std::vector<std::size_t> cells;
  const long long start = map_.index_at(x_m, y_m);
  if (start < 0 || !(to_go.cost[static_cast<std::size_t>(start)] < kInfinity)) return cells;
  const long long columns = map_.geometry().columns;
  long long cell = start;
  cells.push_back(static_cast<std::size_t>(cell));
  for (int step = to_go.step[static_cast<std::size_t>(cell)]; step >= 0;
       step = to_go.step[static_cast<std::size_t>(cell)]) {
    const Step& s = kSteps[static_cast<std::size_t>(step)];
    cell += s.right - s.up * columns;
    cells.push_back(static_cast<std::size_t>(cell));
  }
  return cells;
}

}  // namespace slipway::planner
