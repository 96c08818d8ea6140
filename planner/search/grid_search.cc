#include "planner/search/grid_search.h"

#include <array>
#include <cmath>
#include <limits>

#include "planner/search/graph_search.h"

namespace slipway::planner {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

}  // namespace

double GridSearch::heading_rad(int step) {
  static const std::array<double, kGridSteps> all = [] {
    std::array<double, kGridSteps> made;
    for (std::size_t k = 0; k < kGridSteps; ++k)
      made[k] = std::atan2(kGridDirections[k].up, kGridDirections[k].right);
    return made;
  }();
  return all[static_cast<std::size_t>(step)];
}

const Eigen::Vector2d& GridSearch::direction(int step) {
  static const std::array<Eigen::Vector2d, kGridSteps> all = [] {
    std::array<Eigen::Vector2d, kGridSteps> made;
    for (int k = 0; k < kGridSteps; ++k) made[k] = {std::cos(heading_rad(k)), std::sin(heading_rad(k))};
    return made;
  }();
  return all[static_cast<std::size_t>(step)];
}

std::array<float, kGridSteps> GridSearch::half_lengths_m(const dem::GridGeometry& g) {
  std::array<float, kGridSteps> half;
  for (std::size_t k = 0; k < kGridSteps; ++k)
    half[k] = 0.5F * static_cast<float>(std::hypot(kGridDirections[k].right * g.cell_x_m,
                                                   kGridDirections[k].up * g.cell_y_m));
  return half;
}

GridSearch::GridSearch(const MotionCost& cost) : map_(cost.map()) {
  if (map_.holds_blocks() || map_.cells() > static_cast<std::size_t>(kMaxSearchCells)) {
    cost_ = &cost;
    return;
  }
  per_metre_.reset(new float[map_.cells() * static_cast<std::size_t>(kGridSteps)]);
  for (std::size_t i = 0; i < map_.cells(); ++i)
    for (int k = 0; k < kGridSteps; ++k)
      per_metre_[i * static_cast<std::size_t>(kGridSteps) + static_cast<std::size_t>(k)] =
          found_per_metre(cost, i, k);
}

double GridSearch::per_metre_in(const MotionCost& cost, std::size_t cell, double heading_rad,
                                const Eigen::Vector2d& direction) {
  const TraverseMap& map = cost.map();
  const Passage passage = map.cell(cell).passage;
  bool open = passage == Passage::kFree;
  if (passage == Passage::kNearKeepOut) {
    const Eigen::Vector2d centre = map.centre_m(cell);
    open = map.may_stand({centre.x(), centre.y(), heading_rad});
  }
  return open ? cost.per_metre_in_cell(cell, direction.x(), direction.y())
              : std::numeric_limits<double>::infinity();
}

bool GridSearch::passes_corners(const dem::Cell& from, int step, int driven) const {
  // A knight's move runs between two cells: both must be open in the direction that is driven.
  const GridStep& s = kGridDirections[static_cast<std::size_t>(step)];
  const auto is_open = [&](long long row, long long column) {
    const long long cell = map_.index_of(row, column);
    return cell >= 0 && per_metre(static_cast<std::size_t>(cell), driven) < kInfinity;
  };
  // On a map of blocks a diagonal may not touch the corner of a closed cell: a long way has many corners, and
  // a motion is judged on both sides of each.
  if (map_.holds_blocks() && std::abs(s.right) == 1 && std::abs(s.up) == 1)
    return is_open(from.row - s.up, from.column) && is_open(from.row, from.column + s.right);
  if (std::abs(s.right) + std::abs(s.up) != 3) return true;
  const int half_right = s.right / 2;
  const int half_up = s.up / 2;
  return is_open(from.row - half_up, from.column + half_right) &&
         is_open(from.row - (s.up - half_up), from.column + (s.right - half_right));
}

bool GridSearch::clear_of_keep_outs(const dem::Cell& from, int step) const {
  if (map_.keep_out().empty()) return true;
  const GridStep& s = kGridDirections[static_cast<std::size_t>(step)];
  // A step runs within the rectangle of cells between its ends; free ones are clear wherever the body stands.
  bool near = false;
  for (int up = std::min(0, s.up); up <= std::max(0, s.up); ++up) {
    for (int right = std::min(0, s.right); right <= std::max(0, s.right); ++right) {
      const long long i = map_.index_of(from.row - up, from.column + right);
      near |= i < 0 || map_.cell(static_cast<std::size_t>(i)).passage != Passage::kFree;
    }
  }
  if (!near) return true;
  const Eigen::Vector2d begin = map_.geometry().centre_m(from);
  const Eigen::Vector2d end = map_.geometry().centre_m({from.row - s.up, from.column + s.right});
  const double bearing = std::atan2(end.y() - begin.y(), end.x() - begin.x());
  return !map_.keep_out().hits_along(straight({begin.x(), begin.y(), bearing}, end.x(), end.y()));
}

CostField GridSearch::spread(double x_m, double y_m, bool to_go, const SpreadEnd& end) const {
  CostField field{.cost = std::vector<float>(map_.cells(), kInfinity),
                  .step = std::vector<std::int16_t>(map_.cells(), -1)};
  const long long origin = map_.index_at(x_m, y_m);
  if (origin < 0) return field;
  const std::array<float, kGridSteps> half_length = half_lengths_m(map_.geometry());
  const auto leave = [&](std::uint32_t cell, const auto& reach) {
    const float cost_here = field.cost[cell];
    const dem::Cell from = map_.place_of(cell);
    for (int k = 0; k < kGridSteps; ++k) {
      // k is the direction away from the origin; the rover drives it, or its opposite on the way to a goal.
      const int driven = to_go ? opposite(k) : k;
      const float half = per_metre(cell, driven);
      if (!(half < kInfinity)) continue;
      const long long beside = cell_beyond(map_, from, k);
      if (beside < 0) continue;
      const auto next = static_cast<std::size_t>(beside);
      // Cheaper than this it can't be: most are known at less.
      if (!(cost_here + half_length[k] * half < field.cost[next])) continue;
      const float cost = cost_here + half_length[k] * (half + per_metre(next, driven));
      if (!(cost < field.cost[next]) || !passes_corners(from, k, driven) || !clear_of_keep_outs(from, k))
        continue;
      field.step[next] = static_cast<std::int16_t>(driven);
      reach(static_cast<std::uint32_t>(next), cost);
    }
  };
  search_best_first(
      field.cost, static_cast<std::uint32_t>(origin), [](std::uint32_t, float cost) { return cost; },
      [&](std::uint32_t cell, float) { return static_cast<long long>(cell) == end.at_cell; }, leave,
      end.cancelled);
  return field;
}

double cost_of_way(const MotionCost& cost, const std::vector<std::size_t>& way) {
  double sum = 0.0;
  for (std::size_t k = 1; k < way.size(); ++k) {
    const Eigen::Vector2d step = cost.map().centre_m(way[k]) - cost.map().centre_m(way[k - 1]);
    const Eigen::Vector2d heading = step.normalized();
    sum += 0.5 * step.norm() *
           (cost.per_metre_in_cell(way[k - 1], heading.x(), heading.y()) +
            cost.per_metre_in_cell(way[k], heading.x(), heading.y()));
  }
  return sum;
}

std::vector<std::size_t> GridSearch::way(const CostField& to_go, double x_m, double y_m) const {
  std::vector<std::size_t> cells;
  const long long start = map_.index_at(x_m, y_m);
  if (start < 0 || !(to_go.cost[static_cast<std::size_t>(start)] < kInfinity)) return cells;
  auto cell = static_cast<std::size_t>(start);
  cells.push_back(cell);
  for (int step = to_go.step[cell]; step >= 0; step = to_go.step[cell]) {
    cell = static_cast<std::size_t>(cell_beyond(map_, map_.place_of(cell), step));
    cells.push_back(cell);
  }
  return cells;
}

}  // namespace slipway::planner
