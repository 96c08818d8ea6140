// The cost of a plan on real relief: the whole answer, one search for each planner against the grid's
// optimum, and the look-up in which all searches spend their time.

#include <benchmark/benchmark.h>

#include <memory>
#include <string>

#include "core/angle.h"
#include "core/random.h"
#include "dem/elevation_source.h"
#include "planner/make_plan.h"
#include "planner/search/grid_search.h"
#include "planner/search/leg_search.h"
#include "planner/search/planner_catalogue.h"
#include "planner/search/pose_sampler.h"
#include "planner/search/smooth_route.h"
#include "tests/planner/plan_fixture.h"

namespace {

using namespace slipway;           // NOLINT: a program, not a header
using namespace slipway::planner;  // NOLINT

PlanProblem gale() {
  PlanProblem problem = problem_of("S . .\n. . .\n. . G\n");
  const auto source = dem::open_elevation(SLIPWAY_SOURCE_DIR "/data/terrains/gale/elevation.tif");
  problem.terrain = source.value()->read(source.value()->info().geometry.extent()).value();
  const dem::GridGeometry g = problem.terrain->geometry();
  const auto cells = static_cast<std::size_t>(g.rows) * static_cast<std::size_t>(g.columns);
  problem.soil_map = std::make_shared<dem::SoilMap>(g, std::vector<std::int16_t>(cells, 0),
                                                    std::vector<std::uint8_t>(cells, 1),
                                                    std::vector<dem::SoilClass>{{0, "a", "firm"}});
  problem.beliefs.known = {firm_soil("firm")};
  problem.risk = {};
  problem.start = {8142640.0, -276730.0, std::nullopt};
  problem.goal = {8142440.0, -276500.0, std::nullopt};
  return problem;
}

// The data to which a search holds pointers.
struct World {
  PlanProblem problem = gale();
  KeepOut keep_out{problem.keep_out, *problem.rover};
  GroundTables tables = build_ground_tables(problem);
  TraverseMap map{problem, keep_out, problem.terrain->geometry().extent()};
  MotionCost cost{problem, map, tables, problem.weights};
  GridSearch grid{cost};
  PoseSampler sampler{grid,
                      map,
                      grid.cost_to_come(problem.start.x_m, problem.start.y_m),
                      grid.cost_to_go(problem.goal.x_m, problem.goal.y_m),
                      problem.start.x_m,
                      problem.start.y_m};
};

const World& world() {
  static const World the_world;
  return the_world;
}

void BM_PlanOfThreeRoutesOver300m(benchmark::State& state) {
  const PlanProblem problem = gale();
  NoProgress progress;
  double routes = 0.0;
  for (auto _ : state) {
    const Result<Plan> plan = make_plan(problem, progress);
    if (!plan) return state.SkipWithError(plan.error().detail.c_str());
    routes = static_cast<double>(plan->routes.size());
  }
  state.counters["routes"] = routes;
}
BENCHMARK(BM_PlanOfThreeRoutesOver300m)->Unit(benchmark::kMillisecond)->UseRealTime();

// cost_over_grid_optimum is that of the smoothed route, as the mean over seeds. On the grid turns cost
// nothing, and there are 16 directions.
void BM_Search(benchmark::State& state, const PlannerRow& row, int iterations) {
  const World& w = world();
  const std::unique_ptr<LegPlanner> planner = row.make();
  double sum = 0.0, found = 0.0;
  std::uint64_t seed = 0;
  for (auto _ : state) {
    LegSearch search;
    search.cost = &w.cost;
    search.sampler = &w.sampler;
    search.from = {w.problem.start.x_m, w.problem.start.y_m, 2.3};
    search.to_x_m = w.problem.goal.x_m;
    search.to_y_m = w.problem.goal.y_m;
    search.arrival_rad = {2.3};
    search.seed = ++seed;
    search.iterations = iterations;
    search.range_m = 16.0;
    const std::vector<Pose2> poses = planner->search(search);
    if (poses.empty()) continue;
    sum += fine_cost(w.cost, smooth_leg(w.cost, poses, true)) / w.sampler.optimum();
    found += 1.0;
  }
  state.counters["cost_over_grid_optimum"] = sum / found;
  state.counters["found"] = found / static_cast<double>(seed);
}

void BM_GridSearch(benchmark::State& state) {
  const World& w = world();
  for (auto _ : state) {
    const GridSearch grid(w.cost);
    benchmark::DoNotOptimize(grid.cost_to_go(w.problem.goal.x_m, w.problem.goal.y_m));
  }
}
BENCHMARK(BM_GridSearch)->Unit(benchmark::kMillisecond);

void BM_GroundTables(benchmark::State& state) {
  const PlanProblem problem = gale();
  for (auto _ : state) benchmark::DoNotOptimize(build_ground_tables(problem));
}
BENCHMARK(BM_GroundTables)->Unit(benchmark::kMillisecond)->UseRealTime();

void BM_CostLookUp(benchmark::State& state) {
  const World& w = world();
  std::vector<Pose2> poses;
  for (std::uint64_t n = 0; n < 4096; ++n) poses.push_back(w.sampler.draw(7, n));
  std::size_t i = 0;
  for (auto _ : state) benchmark::DoNotOptimize(w.cost.per_metre(poses[i++ % poses.size()]));
}
BENCHMARK(BM_CostLookUp);

// A planner of the catalogue is a row there and needs no line here.
[[maybe_unused]] const bool kRegistered = [] {
  for (const PlannerRow& row : planner_catalogue()) {
    for (const int iterations : {1000, 3000}) {
      const std::string name = "BM_Search/" + std::string(row.name) + "/" + std::to_string(iterations);
      benchmark::RegisterBenchmark(name.c_str(), BM_Search, row, iterations)
          ->Unit(benchmark::kMillisecond)
          ->Iterations(8);
    }
  }
  return true;
}();

}  // namespace
