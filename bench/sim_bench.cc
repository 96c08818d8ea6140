// Cost of the laws and of the quasi-static rung, per unit of work. Ratios within one run compare machines;
// the absolute figures are in docs/validation.md with the machine they were measured on.
#include <benchmark/benchmark.h>

#include <cmath>

#include "core/angle.h"
#include "sim/drive_prediction.h"
#include "sim/entry_angle.h"
#include "sim/quasi_static.h"
#include "sim/slip_table.h"
#include "sim/soil_law_catalogue.h"
#include "sim/wheel_forces.h"
#include "tests/sim/reference_models.h"

namespace slipway::sim {
namespace {

constexpr WheelGeometry kWheel{0.125, 0.16};

// One wheel's three forces and torque at a given entry angle.
void BM_WheelForces(benchmark::State& state) {
  const Soil soil = sandy_loam();
  double theta = 0.30;
  for (auto _ : state) {
    theta = theta > 0.45 ? 0.30 : theta + 1e-6;
    benchmark::DoNotOptimize(wheel_forces(kWheel, soil, theta, {0.85, 0.05}));
  }
}
BENCHMARK(BM_WheelForces);

// The same with the entry angle solved for a load: what a single-wheel rig reports.
void BM_BalancedWheel(benchmark::State& state) {
  const Soil soil = sandy_loam();
  double load = 80.0;
  for (auto _ : state) {
    load = load > 140.0 ? 80.0 : load + 0.01;
    benchmark::DoNotOptimize(balanced_entry_angle_rad(kWheel, soil, load, {0.85, 0.05}));
  }
}
BENCHMARK(BM_BalancedWheel);

// The floor: shear at sixteen nodes in two directions, eight pressures, and the nodes' sines and cosines.
void BM_TranscendentalsOfOneWheel(benchmark::State& state) {
  ArcValues x = ArcValues::LinSpaced(0.1, 0.9);
  for (auto _ : state) {
    benchmark::DoNotOptimize(x.data());
    ArcValues sum = x.exp() + (2.0 * x).exp() + (3.0 * x).exp() + (4.0 * x).exp() + (0.9 * x.log()).exp();
    sum += x.sin() + x.cos() + (0.5 * x).sin() + (0.5 * x).cos();
    benchmark::DoNotOptimize(sum);
  }
}
BENCHMARK(BM_TranscendentalsOfOneWheel);

void BM_SixWheelStation(benchmark::State& state) {
  const RoverModel rover = six_wheeler();
  QuasiStaticSolver solver(rover, 3.71);
  const Soil soil = sandy_loam();
  const bool warm = state.range(0) != 0;
  int k = 0;
  for (auto _ : state) {
    ++k;
    const Stance stance = stance_on_plane(rover, {0.1 * std::sin(0.05 * k), 0.2 * std::sin(0.03 * k), 0.0});
    if (!warm) solver.reset();
    benchmark::DoNotOptimize(solver.solve(stance, soil, {.speed_m_s = 0.04}));
  }
}
BENCHMARK(BM_SixWheelStation)->ArgName("warm")->Arg(1)->Arg(0);

void BM_ImmobilisedStation(benchmark::State& state) {
  const RoverModel rover = six_wheeler();
  QuasiStaticSolver solver(rover, 3.71);
  const Stance stance = stance_on_plane(rover, {0.05, rad_from_deg(-28.0), 0.0});
  for (auto _ : state) benchmark::DoNotOptimize(solver.solve(stance, sandy_loam(), {.speed_m_s = 0.04}));
}
BENCHMARK(BM_ImmobilisedStation);

void BM_Settle(benchmark::State& state) {
  const RoverModel rover = six_wheeler();
  const FunctionGround ground([](double x, double y) { return 0.1 * std::sin(1.3 * x) * std::cos(0.9 * y); });
  double x = 0.0;
  for (auto _ : state) benchmark::DoNotOptimize(settle(rover, ground, {x += 0.01, 0.3, 0.4}));
}
BENCHMARK(BM_Settle);

void BM_TableLookup(benchmark::State& state) {
  const RoverModel rover = six_wheeler();
  const SlipTable table(rover, 3.71, sandy_loam(), rad_from_deg(30.0), rad_from_deg(2.5));
  double pitch = -0.4;
  for (auto _ : state) {
    pitch = pitch > 0.4 ? -0.4 : pitch + 1e-4;
    benchmark::DoNotOptimize(table.at(pitch, 0.1));
  }
}
BENCHMARK(BM_TableLookup);

void BM_BuildTable(benchmark::State& state) {
  const RoverModel rover = six_wheeler();
  for (auto _ : state)
    benchmark::DoNotOptimize(SlipTable(rover, 3.71, sandy_loam(), rad_from_deg(30.0), rad_from_deg(2.5)));
}
BENCHMARK(BM_BuildTable)->Unit(benchmark::kMillisecond);

// A 100 m drive with the default number of soil draws; cost per metre is the counter.
void BM_PredictDrive(benchmark::State& state) {
  const RoverModel rover = six_wheeler();
  const FunctionGround ground([](double x, double y) { return 0.1 * std::sin(0.8 * x) * std::cos(0.5 * y); });
  const SoilBeliefs beliefs{{spread("loam", sandy_loam(), 0.3)}, spread("unknown_ground", loose_sand(), 0.5)};
  std::vector<PathStation> path;
  for (int k = 0; k <= 400; ++k) path.push_back({.pose = {0.25 * k, 0.0, 0.0}, .distance_m = 0.25 * k});
  RiskOptions risk;
  risk.draws = static_cast<int>(state.range(0));
  NoProgress progress;
  for (auto _ : state)
    benchmark::DoNotOptimize(predict_drive(rover, 3.71, ground, beliefs, path, {}, risk, 1, progress));
  state.counters["per_metre"] =
      benchmark::Counter(100.0, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
BENCHMARK(BM_PredictDrive)->ArgName("draws")->Arg(0)->Arg(24)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace slipway::sim
