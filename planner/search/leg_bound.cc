#include "planner/search/leg_bound.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <vector>

#include "planner/search/graph_search.h"

namespace slipway::planner {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr int kFurthest = 3;  // of a step, in cells along an axis
// The grid's own cost to go, of 16 directions, leads the search: no way in 32 is cheaper than this share of
// it, which on even ground is 0.973.
constexpr double kLeastOfGrid = 0.9;

struct Step {
  // A cell that it passes, and the part of its length there.
  struct Part {
    GridStep cell;
    double length_m = 0.0;
  };

  int right = 0, up = 0;
  double heading_rad = 0.0;
  Eigen::Vector2d direction;
  std::vector<Part> parts;
};

// From centre to centre, cut where it leaves a cell: at odd halves along either axis.
std::vector<Step::Part> parts_of(int right, int up, double length_m) {
  std::vector<double> cuts{0.0, 1.0};
  for (const int size : {std::abs(right), std::abs(up)})
    for (int k = 0; k < size; ++k) cuts.push_back((k + 0.5) / size);
  std::sort(cuts.begin(), cuts.end());
  std::vector<Step::Part> parts;
  for (std::size_t k = 1; k < cuts.size(); ++k) {
    const double share = cuts[k] - cuts[k - 1], middle = 0.5 * (cuts[k] + cuts[k - 1]);
    if (share > 1e-9)
      parts.push_back(
          {{static_cast<int>(std::lround(middle * right)), static_cast<int>(std::lround(middle * up))},
           share * length_m});
  }
  return parts;
}

// Counter-clockwise.
std::vector<Step> steps_on(const dem::GridGeometry& g) {
  std::vector<Step> steps;
  for (int up = -kFurthest; up <= kFurthest; ++up) {
    for (int right = -kFurthest; right <= kFurthest; ++right) {
      if (std::gcd(right, up) != 1) continue;
      const Eigen::Vector2d way(right * g.cell_x_m, up * g.cell_y_m);
      steps.push_back({.right = right,
                       .up = up,
                       .heading_rad = std::atan2(way.y(), way.x()),
                       .direction = way.normalized(),
                       .parts = parts_of(right, up, way.norm())});
    }
  }
  std::sort(steps.begin(), steps.end(),
            [](const Step& a, const Step& b) { return a.heading_rad < b.heading_rad; });
  return steps;
}

double least_share_of_length(const std::vector<Step>& steps) {
  double widest = steps.front().heading_rad + 2.0 * std::numbers::pi - steps.back().heading_rad;
  for (std::size_t k = 1; k < steps.size(); ++k)
    widest = std::max(widest, steps[k].heading_rad - steps[k - 1].heading_rad);
  return std::cos(0.5 * widest);
}

double cost_of_step(const MotionCost& cost, const dem::Cell& from, const Step& step) {
  double sum = 0.0;
  for (const Step::Part& part : step.parts) {
    const long long cell = cost.map().index_of(from.row - part.cell.up, from.column + part.cell.right);
    if (cell < 0) return kInfinity;
    sum += part.length_m *
           GridSearch::per_metre_in(cost, static_cast<std::size_t>(cell), step.heading_rad, step.direction);
    if (!(sum < kInfinity)) break;
  }
  return sum;
}

// Between a place and the centre of its cell, one way and the other.
double of_end(const MotionCost& cost, std::size_t cell, double x_m, double y_m) {
  const Eigen::Vector2d way = Eigen::Vector2d(x_m, y_m) - cost.map().centre_m(cell);
  const double length = way.norm();
  if (length == 0.0) return 0.0;
  const Eigen::Vector2d d = way / length;
  return length *
         std::max(cost.per_metre_in_cell(cell, d.x(), d.y()), cost.per_metre_in_cell(cell, -d.x(), -d.y()));
}

}  // namespace

double least_cost_of_leg(const MotionCost& cost, const CostField& to_go, const Waypoint& from,
                         const Waypoint& to) {
  const TraverseMap& map = cost.map();
  const long long start = map.index_at(from.x_m, from.y_m), goal = map.index_at(to.x_m, to.y_m);
  if (start < 0 || goal < 0) return 0.0;
  const std::vector<Step> steps = steps_on(map.geometry());
  std::vector<double> reached(map.cells(), kInfinity);
  search_best_first(
      reached, static_cast<std::uint32_t>(start),
      [&](std::uint32_t cell, double sum) { return sum + kLeastOfGrid * to_go.cost[cell]; },
      [&](std::uint32_t cell, double) { return static_cast<long long>(cell) == goal; },
      [&](std::uint32_t cell, const auto& reach) {
        const dem::Cell place = map.place_of(cell);
        for (const Step& step : steps) {
          const long long next = map.index_of(place.row - step.up, place.column + step.right);
          if (next < 0 || !(to_go.cost[static_cast<std::size_t>(next)] < kInfinity)) continue;
          const double sum = reached[cell] + cost_of_step(cost, place, step);
          if (sum < kInfinity) reach(static_cast<std::uint32_t>(next), sum);
        }
      });
  const double least = least_share_of_length(steps) * reached[static_cast<std::size_t>(goal)] -
                       of_end(cost, static_cast<std::size_t>(start), from.x_m, from.y_m) -
                       of_end(cost, static_cast<std::size_t>(goal), to.x_m, to.y_m);
  return least < kInfinity ? std::max(0.0, least) : 0.0;
}

}  // namespace slipway::planner
