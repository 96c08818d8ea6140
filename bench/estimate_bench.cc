#include <benchmark/benchmark.h>

#include "gap/estimate/soil_estimation.h"
#include "tests/gap/soil_tests.h"

// The ARTEMIS paper's estimation: torque, thrust and sinkage of so many wheel tests, from 49 % off.
namespace slipway::gap {
namespace {

void estimate(benchmark::State& state, bool profile) {
  const sim::Soil truth = dry_sand();
  const SoilData data =
      made_wheel_tests(truth, {.count = static_cast<int>(state.range(0)), .noise = 0.02, .seed = 3});
  const sim::SoilDistribution start = start_49_percent_off(truth);
  NoProgress progress;
  std::size_t evaluations = 0;
  for (auto _ : state) {
    const auto e = estimate_soil(start, data, {.profile = profile}, progress);
    evaluations = e->evaluations;
    benchmark::DoNotOptimize(e);
  }
  state.counters["evaluations"] = static_cast<double>(evaluations);
}

void estimate_soil_with_profiles(benchmark::State& state) {
  estimate(state, true);
}
void estimate_soil_alone(benchmark::State& state) {
  estimate(state, false);
}
BENCHMARK(estimate_soil_with_profiles)->Arg(10)->Arg(50)->Arg(200)->Unit(benchmark::kMillisecond);
BENCHMARK(estimate_soil_alone)->Arg(10)->Arg(50)->Arg(200)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace slipway::gap
