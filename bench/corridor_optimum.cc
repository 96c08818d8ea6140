// What the search over any distance costs against Dijkstra in 16 directions on every cell, for random pairs
// on a map (see fractal_map, hard_maps.py). Usage:
// corridor_optimum MAP.tif [distance_m=1000] [pairs=20] [seed=1] [zones]     with random keep-outs
//
// The yardstick leaves out cells alone that no way as cheap as the corridor's can come to. A pair between
// which it finds none is not counted; one that the corridor alone misses is.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <limits>
#include <numeric>
#include <queue>
#include <string_view>
#include <utility>
#include <vector>

#include "core/angle.h"
#include "core/random.h"
#include "dem/elevation_source.h"
#include "planner/search/far_search.h"
#include "tests/planner/plan_fixture.h"

namespace {

using namespace slipway;           // NOLINT: a program, not a header
using namespace slipway::planner;  // NOLINT

// The terrain around a pair that is read, in half distances to each side.
constexpr double kRooms = 2.0;
// What the corridor may cost more.
constexpr double kAllowed = 1.02;

// The blocks that a way of at most this length from start to goal can meet.
std::vector<std::uint32_t> blocks_in_reach(const PlanProblem& problem, const dem::GridGeometry& g,
                                           double length_m) {
  const double half_diagonal = 0.5 * kBlockCells * std::hypot(g.cell_x_m, g.cell_y_m);
  const auto blocks = static_cast<std::uint32_t>(block_columns(g) * block_rows(g));
  std::vector<std::uint32_t> held;
  for (std::uint32_t block = 0; block < blocks; ++block) {
    const dem::CellWindow w = block_window(g, block);
    const Eigen::Vector2d middle =
        0.5 * (g.centre_m({w.row, w.column}) + g.centre_m({w.row + w.rows - 1, w.column + w.columns - 1}));
    const double way = std::hypot(middle.x() - problem.start.x_m, middle.y() - problem.start.y_m) +
                       std::hypot(middle.x() - problem.goal.x_m, middle.y() - problem.goal.y_m);
    if (way <= length_m + 2.0 * half_diagonal) held.push_back(block);
  }
  return held;
}

// The direction of a step from cell to cell, `right` and `up` cells on.
struct Step {
  int right, up;
  double length_m, c, s;
};

// The yardstick: Dijkstra over the map's cells in 16 directions, written for itself. A step costs its length
// times the mean of what a metre costs in the cells at its two ends, driven in its direction; the cells that
// it runs through must be open that way, and the body must keep clear of keep-outs. Turns are free.
class AllCells {
 public:
  AllCells(const MotionCost& cost, const KeepOut& keep_out)
      : cost_(cost), map_(cost.map()), keep_out_(keep_out) {
    const dem::GridGeometry& g = map_.geometry();
    for (int right = -2; right <= 2; ++right) {
      for (int up = -2; up <= 2; ++up) {
        if (std::abs(right) + std::abs(up) == 0 || std::gcd(right, up) != 1) continue;
        const double x = right * g.cell_x_m, y = up * g.cell_y_m, length = std::hypot(x, y);
        steps_.push_back({right, up, length, x / length, y / length});
      }
    }
  }

  double least(const Waypoint& start, const Waypoint& goal) const {
    using Reached = std::pair<double, long long>;
    const long long from = map_.index_at(start.x_m, start.y_m), to = map_.index_at(goal.x_m, goal.y_m);
    if (from < 0 || to < 0) return kInfinity;
    std::vector<double> cost(map_.cells(), kInfinity);
    std::priority_queue<Reached, std::vector<Reached>, std::greater<>> open;
    cost[static_cast<std::size_t>(from)] = 0.0;
    for (open.emplace(0.0, from); !open.empty();) {
      const auto [spent, here] = open.top();
      open.pop();
      if (here == to) return spent;
      if (spent > cost[static_cast<std::size_t>(here)]) continue;
      const dem::Cell at = map_.place_of(static_cast<std::size_t>(here));
      for (const Step& step : steps_) {
        const long long next = map_.index_of(at.row - step.up, at.column + step.right);
        if (next < 0) continue;
        const double sum = spent + 0.5 * step.length_m * (per_metre(here, step) + per_metre(next, step));
        if (!(sum < cost[static_cast<std::size_t>(next)]) || !is_open_between(at, step)) continue;
        cost[static_cast<std::size_t>(next)] = sum;
        open.emplace(sum, next);
      }
    }
    return kInfinity;
  }

 private:
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();

  double per_metre(long long index, const Step& step) const {
    if (index < 0) return kInfinity;
    const auto cell = static_cast<std::size_t>(index);
    const Passage passage = map_.cell(cell).passage;
    if (passage != Passage::kFree) {
      const Eigen::Vector2d at = map_.centre_m(cell);
      if (passage != Passage::kNearKeepOut || !map_.may_stand({at.x(), at.y(), std::atan2(step.s, step.c)}))
        return kInfinity;
    }
    return cost_.per_metre_in_cell(cell, step.c, step.s);
  }

  bool is_open_between(const dem::Cell& at, const Step& step) const {
    // A step of two by one runs through the two cells beside its middle.
    if (std::abs(step.right) + std::abs(step.up) == 3)
      for (const int half : {0, 1}) {
        const int right = std::abs(step.right) == 2 ? step.right / 2 : half * step.right;
        const int up = std::abs(step.up) == 2 ? step.up / 2 : half * step.up;
        if (!(per_metre(map_.index_of(at.row - up, at.column + right), step) < kInfinity)) return false;
      }
    if (keep_out_.empty()) return true;
    const Eigen::Vector2d begin = map_.geometry().centre_m(at);
    const Eigen::Vector2d end = map_.geometry().centre_m({at.row - step.up, at.column + step.right});
    const Pose2 pose{begin.x(), begin.y(), std::atan2(step.s, step.c)};
    return !keep_out_.hits_along(straight(pose, end.x(), end.y()));
  }

  const MotionCost& cost_;
  const TraverseMap& map_;
  const KeepOut& keep_out_;
  std::vector<Step> steps_;
};

// The least cost on all cells of the terrain. No way that costs at most `found` is longer than this at the
// least cost of a metre, so that cells beyond an ellipse can't lie on the cheapest.
double on_all_cells(const PlanProblem& problem, const KeepOut& keep_out, const GroundTables& tables,
                    double found) {
  NoProgress progress;
  const dem::GridGeometry g = finest_geometry(problem.terrain->geometry());
  const TraverseMap nowhere(problem, keep_out, std::vector<std::uint32_t>{}, progress);
  MotionCost cost(problem, nowhere, tables, problem.weights, problem.ranking.ranked_tail());
  const TraverseMap map(problem, keep_out, blocks_in_reach(problem, g, found / cost.least_per_metre()),
                        progress);
  cost = cost.on(map);
  return AllCells(cost, keep_out).least(problem.start, problem.goal);
}

// Triangles of up to 120 m, about as many as there are hectares in a square of the distance.
std::vector<Polygon> random_zones(const PlanProblem& problem, double distance_m, std::uint64_t key) {
  std::vector<Polygon> zones;
  const Eigen::Vector2d middle(0.5 * (problem.start.x_m + problem.goal.x_m),
                               0.5 * (problem.start.y_m + problem.goal.y_m));
  const auto count = static_cast<std::uint64_t>(distance_m * distance_m / 10'000.0);
  for (std::uint64_t k = 0; k < count; ++k) {
    const std::uint64_t own = random_key(key, k);
    const auto spread = [&](std::uint64_t n, double width) { return (random_uniform(own, n) - 0.5) * width; };
    const Eigen::Vector2d at =
        middle + Eigen::Vector2d(spread(0, 1.6 * distance_m), spread(1, 1.6 * distance_m));
    Polygon zone;
    for (std::uint64_t corner = 0; corner < 3; ++corner)
      zone.push_back(at + Eigen::Vector2d(spread(2 + 2 * corner, 120.0), spread(3 + 2 * corner, 120.0)));
    zones.push_back(zone);
  }
  return zones;
}

double seconds_since(std::chrono::steady_clock::time_point then) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - then).count();
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) return std::puts("corridor_optimum MAP.tif [distance_m] [pairs] [seed] [zones]"), 2;
  const double distance = argc > 2 ? std::atof(argv[2]) : 1000.0;
  const int pairs = argc > 3 ? std::atoi(argv[3]) : 20;
  const std::uint64_t seed = argc > 4 ? std::strtoull(argv[4], nullptr, 10) : 1;
  const bool with_zones = argc > 5 && std::string_view(argv[5]) == "zones";
  const auto source = dem::open_elevation(argv[1]);
  if (!source) return std::puts(source.error().detail.c_str()), 1;
  const dem::Extent map = (*source)->info().geometry.extent();
  std::printf("pair  all cells  corridor  ratio  route/all  all s  corridor s\n");
  double worst = 0.0, sum = 0.0;
  int counted = 0, above = 0;
  for (int pair = 0, draw = 0; pair < pairs && draw < 40 * pairs; ++draw) {
    const std::uint64_t key = random_key(seed, static_cast<std::uint64_t>(draw));
    const double turn = 2.0 * 3.14159265358979 * random_uniform(key, 0);
    PlanProblem problem = problem_of("S . .\n. . .\n. . G\n");
    problem.routes = 1;
    const double x = map.west_m + random_uniform(key, 1) * (map.east_m - map.west_m);
    const double y = map.south_m + random_uniform(key, 2) * (map.north_m - map.south_m);
    problem.start = {x, y, std::nullopt};
    problem.goal = {x + distance * std::cos(turn), y + distance * std::sin(turn), std::nullopt};
    if (problem.goal.x_m < map.west_m + 20 || problem.goal.x_m > map.east_m - 20 ||
        problem.goal.y_m < map.south_m + 20 || problem.goal.y_m > map.north_m - 20)
      continue;
    problem.terrain = (*source)->read(search_extent(problem, kRooms)).value();
    problem.soil_map = nullptr;
    problem.beliefs.known.clear();
    problem.beliefs.unknown = firm_soil("firm");
    if (with_zones) problem.keep_out = random_zones(problem, distance, key);
    const KeepOut keep_out(problem.keep_out, *problem.rover);
    const GroundTables tables = build_ground_tables(problem);
    NoProgress progress;
    auto begun = std::chrono::steady_clock::now();
    const FarProposal far = propose_far_routes(problem, {}, keep_out, tables, progress);
    const double far_s = seconds_since(begun);
    // Where the corridor has no way, what it would have to be beaten by is a way of four times the distance.
    const TraverseMap nowhere(problem, keep_out, std::vector<std::uint32_t>{}, progress);
    const MotionCost cost(problem, nowhere, tables, problem.weights);
    const double most = std::min<double>(far.proposal.grid_optimum, 4.0 * distance * cost.least_per_metre());
    begun = std::chrono::steady_clock::now();
    const double all = on_all_cells(problem, keep_out, tables, most);
    const double all_s = seconds_since(begun);
    if (!std::isfinite(all)) continue;
    ++pair;
    const double ratio = far.proposal.grid_optimum / all;
    const std::vector<std::size_t> order = far.proposal.by_cost();
    const double route = order.empty() ? 0.0 : far.proposal.candidates[order.front()].cost / all;
    std::printf("%4d %10.2f %9.2f %6.4f %10.4f %6.1f %11.1f\n", pair, all, far.proposal.grid_optimum, ratio,
                route, all_s, far_s);
    std::fflush(stdout);
    if (!std::isfinite(ratio)) continue;
    worst = std::max(worst, ratio);
    sum += ratio;
    ++counted;
    above += ratio > kAllowed ? 1 : 0;
  }
  std::printf(
      "%d pairs of %.0f m: mean ratio %.4f, worst %.4f, %d above %.2f; a way missed by the corridor between "
      "%d more\n",
      counted, distance, sum / std::max(1, counted), worst, above, kAllowed, pairs - counted);
  return 0;
}
