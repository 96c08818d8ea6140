// What the search over any distance costs against Dijkstra in 16 directions on every cell, for random pairs
// on a map (see fractal_map). Usage: corridor_optimum MAP.tif [distance_m=1000] [pairs=20] [seed=1]
//
// The corridor's sum holds what a metre beside closed ground costs more, which the yardstick does not. The
// yardstick leaves out cells alone that no way as cheap as the corridor's can come to. A pair between which
// it finds none is not counted; one that the corridor alone misses is.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <vector>

#include "core/angle.h"
#include "core/random.h"
#include "dem/elevation_source.h"
#include "planner/search/far_search.h"
#include "planner/search/grid_search.h"
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
  const auto blocks =
      static_cast<std::uint32_t>(block_columns(g) * ((g.rows + kBlockCells - 1) / kBlockCells));
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

// The least cost on all cells of the terrain. No way that costs at most `found` is longer than this at the
// least cost of a metre, so that cells beyond an ellipse can't lie on the cheapest.
double on_all_cells(const PlanProblem& problem, const KeepOut& none, const GroundTables& tables,
                    double found) {
  NoProgress progress;
  const dem::GridGeometry g = finest_geometry(problem.terrain->geometry());
  const TraverseMap nowhere(problem, none, std::vector<std::uint32_t>{}, progress);
  MotionCost cost(problem, nowhere, tables, problem.weights, problem.ranking.ranked_tail());
  const TraverseMap map(problem, none, blocks_in_reach(problem, g, found / cost.least_per_metre()), progress);
  cost = cost.on(map);
  const GridSearch grid(cost);
  const long long start = map.index_at(problem.start.x_m, problem.start.y_m);
  if (start < 0) return std::numeric_limits<double>::infinity();
  const CostField to_go = grid.cost_to_go(problem.goal.x_m, problem.goal.y_m, {start, {}});
  return to_go.cost[static_cast<std::size_t>(start)];
}

double seconds_since(std::chrono::steady_clock::time_point then) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - then).count();
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) return std::puts("corridor_optimum MAP.tif [distance_m] [pairs] [seed]"), 2;
  const double distance = argc > 2 ? std::atof(argv[2]) : 1000.0;
  const int pairs = argc > 3 ? std::atoi(argv[3]) : 20;
  const std::uint64_t seed = argc > 4 ? std::strtoull(argv[4], nullptr, 10) : 1;
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
    const KeepOut none({}, *problem.rover);
    const GroundTables tables = build_ground_tables(problem);
    NoProgress progress;
    auto begun = std::chrono::steady_clock::now();
    const FarProposal far = propose_far_routes(problem, {}, none, tables, progress);
    const double far_s = seconds_since(begun);
    // Where the corridor has no way, what it would have to be beaten by is a way of four times the distance.
    const TraverseMap nowhere(problem, none, std::vector<std::uint32_t>{}, progress);
    const MotionCost cost(problem, nowhere, tables, problem.weights);
    const double most = std::min<double>(far.proposal.grid_optimum, 4.0 * distance * cost.least_per_metre());
    begun = std::chrono::steady_clock::now();
    const double all = on_all_cells(problem, none, tables, most);
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
