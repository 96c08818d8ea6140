// How fast a map's cells are computed, beside the slip table's look-up, which is the limit of a map at a
// heading: a tile of 512 x 512 cells of rolling ground on one core. The file and the reading of the terrain
// are not in it; `time slipway map` has them.

#include <benchmark/benchmark.h>

#include <cmath>
#include <memory>
#include <optional>
#include <vector>

#include "bench/gale_site.h"
#include "planner/maps/cell_ground.h"
#include "planner/maps/cell_map.h"
#include "sim/quasi_static/slip_table.h"

namespace {

using namespace slipway;           // NOLINT: a program, not a header
using namespace slipway::planner;  // NOLINT

constexpr int kSide = 512;

struct Ground {
  std::shared_ptr<const dem::Terrain> terrain;
  std::shared_ptr<const dem::SoilMap> soils;
};

// All of it the first of Gale's soils.
Ground rolling(const PlanProblem& problem) {
  const dem::GridGeometry g{kSide, kSide, 0.0, kSide, 1.0, 1.0};
  std::vector<float> heights;
  for (int row = 0; row < kSide; ++row)
    for (int column = 0; column < kSide; ++column)
      heights.push_back(static_cast<float>(3.0 * std::sin(column / 21.0) * std::cos(row / 17.0) +
                                           std::sin(row / 5.0) * 0.3));
  const std::vector<std::uint8_t> all(heights.size(), 1);
  const std::string name = problem.soil_map->soils().front();
  return {std::make_shared<dem::Terrain>(g, std::move(heights), all),
          std::make_shared<dem::SoilMap>(g, std::vector<std::int16_t>(all.size(), 0), all,
                                         std::vector<dem::SoilClass>{{0, name, name}})};
}

void map_of(benchmark::State& state, MapKind kind, std::optional<double> heading_rad) {
  const PlanProblem problem = bench::gale().problem;
  const Ground ground = rolling(problem);
  const CellMap map({.drive = problem, .kind = kind, .heading_rad = heading_rad});
  const dem::Extent extent = ground.terrain->geometry().extent();
  const auto values = [&] {
    return map.values(*ground.terrain, *ground.soils, {0, 0, kSide, kSide}, extent);
  };
  benchmark::DoNotOptimize(values());  // makes the tables
  for (auto _ : state) benchmark::DoNotOptimize(values());
  state.SetItemsProcessed(state.iterations() * kSide * kSide);
}

void BM_SlipTableLookUp(benchmark::State& state) {
  const PlanProblem problem = bench::gale().problem;
  const sim::SlipTable table(*problem.rover, problem.gravity_m_s2, problem.beliefs.known.front().mean, 0.61,
                             0.0436);
  double pitch = -0.2;
  for (auto _ : state) {
    benchmark::DoNotOptimize(table.at(pitch, 0.05));
    pitch = pitch > 0.2 ? -0.2 : pitch + 1e-4;
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(BM_SlipTableLookUp);

void BM_GroundOfCells(benchmark::State& state) {
  const PlanProblem problem = bench::gale().problem;
  const Ground ground = rolling(problem);
  for (auto _ : state)
    benchmark::DoNotOptimize(cell_ground(*ground.terrain, {0, 0, kSide, kSide},
                                         ground.terrain->geometry().extent(), *problem.rover, false));
  state.SetItemsProcessed(state.iterations() * kSide * kSide);
}
BENCHMARK(BM_GroundOfCells)->Unit(benchmark::kMillisecond);

void BM_SlipWorst(benchmark::State& state) {
  map_of(state, MapKind::kSlipWorst, std::nullopt);
}
BENCHMARK(BM_SlipWorst)->Unit(benchmark::kMillisecond);

void BM_SlipAtHeading(benchmark::State& state) {
  map_of(state, MapKind::kSlip, 0.7);
}
BENCHMARK(BM_SlipAtHeading)->Unit(benchmark::kMillisecond);

void BM_StopRisk(benchmark::State& state) {
  map_of(state, MapKind::kStopRisk, std::nullopt);
}
BENCHMARK(BM_StopRisk)->Unit(benchmark::kMillisecond);

void BM_Verdict(benchmark::State& state) {
  map_of(state, MapKind::kVerdict, std::nullopt);
}
BENCHMARK(BM_Verdict)->Unit(benchmark::kMillisecond);

}  // namespace
