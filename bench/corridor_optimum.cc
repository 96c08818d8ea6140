// What the search over any distance costs against Dijkstra in 16 directions on every cell, for random pairs
// on a map (see fractal_map). Usage: corridor_optimum MAP.tif [distance_m=1000] [pairs=20] [seed=1] The
// corridor's sum holds what a metre beside closed ground costs more, which the yardstick does not.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
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

// The least cost on all cells of the box around both places with half the distance as room.
double on_all_cells(const PlanProblem& problem, const KeepOut& none, const GroundTables& tables) {
  NoProgress progress;
  const dem::GridGeometry g = finest_geometry(problem.terrain->geometry());
  const dem::CellWindow box = *g.window(search_extent(problem));
  std::vector<std::uint32_t> blocks;
  for (int row = box.row / kBlockCells; row <= (box.row + box.rows - 1) / kBlockCells; ++row)
    for (int column = box.column / kBlockCells; column <= (box.column + box.columns - 1) / kBlockCells;
         ++column)
      blocks.push_back(static_cast<std::uint32_t>(row * block_columns(g) + column));
  const TraverseMap map(problem, none, std::move(blocks), progress);
  const MotionCost cost(problem, map, tables, problem.weights, problem.ranking.ranked_tail());
  const GridSearch grid(cost);
  const long long start = map.index_at(problem.start.x_m, problem.start.y_m);
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
  int counted = 0;
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
    problem.terrain = (*source)->read(search_extent(problem)).value();
    problem.soil_map = nullptr;
    problem.beliefs.known.clear();
    problem.beliefs.unknown = firm_soil("firm");
    const KeepOut none({}, *problem.rover);
    const GroundTables tables = build_ground_tables(problem);
    auto begun = std::chrono::steady_clock::now();
    const double all = on_all_cells(problem, none, tables);
    const double all_s = seconds_since(begun);
    if (!std::isfinite(all)) continue;
    ++pair;
    NoProgress progress;
    begun = std::chrono::steady_clock::now();
    const FarProposal far = propose_far_routes(problem, {}, none, tables, progress);
    const double far_s = seconds_since(begun);
    const double ratio = far.proposal.grid_optimum / all;
    const std::vector<std::size_t> order = far.proposal.by_cost();
    const double route = order.empty() ? 0.0 : far.proposal.candidates[order.front()].cost / all;
    std::printf("%4d %10.2f %9.2f %6.4f %10.4f %6.1f %11.1f\n", pair, all, far.proposal.grid_optimum, ratio,
                route, all_s, far_s);
    std::fflush(stdout);
    worst = std::max(worst, ratio);
    sum += ratio;
    ++counted;
  }
  std::printf("%d pairs of %.0f m: mean ratio %.4f, worst %.4f\n", counted, distance,
              sum / std::max(1, counted), worst);
  return 0;
}
