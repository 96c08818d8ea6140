// The cost of the laws and of the quasi-static level per unit of work. Ratios within one run can be compared
// between machines; the absolute figures are in docs/validation.md with the machine on which they were
// measured.
#include <benchmark/benchmark.h>

#include <cmath>
#include <string_view>
#include <vector>

#include "bench/packed_exponentials.h"
#include "core/angle.h"
#include "sim/prediction/drive_prediction.h"
#include "sim/quasi_static/quasi_static.h"
#include "sim/quasi_static/slip_table.h"
#include "sim/wheel/entry_angle.h"
#include "sim/wheel/wheel_forces.h"
#include "sim/wheel/wheel_kernel.h"
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

// The same with the entry angle solved for a load, as for a single-wheel rig.
void BM_BalancedWheel(benchmark::State& state) {
  const Soil soil = sandy_loam();
  double load = 80.0;
  for (auto _ : state) {
    load = load > 140.0 ? 80.0 : load + 0.01;
    benchmark::DoNotOptimize(balanced_entry_angle_rad(kWheel, soil, load, {0.85, 0.05}));
  }
}
BENCHMARK(BM_BalancedWheel);

Soil every_effect() {
  Soil soil = sandy_loam();
  soil.n1 = 0.3;
  soil.n1_skid = soil.n1_lateral = 0.1;
  soil.exit_angle_ratio = 0.2;
  soil.shear_coupling = 1.0;
  soil.bulldozing = soil.side_bulldozing = 0.7;
  soil.crust = {2000.0, 0.005};
  soil.hardpan = {1e6, 0.02};
  soil.slip_directed = 1.0;
  soil.inclined_softening = 2.0;
  soil.digging = {.rim_share = 0.16, .cleat_share = 0.5, .sideways = 1.6};
  soil.ploughing = {.front = 8.0, .wall = 12.0, .heap = 1.7, .wall_friction = 0.4};
  return soil;
}
constexpr WheelGeometry kGrouserWheel{.radius_m = 0.125,
                                      .width_m = 0.16,
                                      .grousers = {.height_m = 0.01, .count = 24.0, .shear_by_spacing = 1.0},
                                      .rim_friction = 0.9};

// Three forces and the torque with every effect of the wheel on.
void BM_WheelForcesAllEffects(benchmark::State& state) {
  const Soil soil = every_effect();
  double theta = 0.30;
  for (auto _ : state) {
    theta = theta > 0.45 ? 0.30 : theta + 1e-6;
    benchmark::DoNotOptimize(wheel_forces(kGrouserWheel, soil, theta, {0.85, 0.05}));
  }
  state.SetLabel(wheel_kernel().instruction_set);
}
BENCHMARK(BM_WheelForcesAllEffects);

// The same for 1,024 draws of the soil at once; the counter is the time of one draw. With arg 1 every effect
// is on.
void BM_WheelForcesOverDraws(benchmark::State& state) {
  constexpr int kDraws = 1024;
  const bool all = state.range(0) != 0;
  std::vector<Soil> soils(kDraws, all ? every_effect() : sandy_loam());
  for (int k = 0; k < kDraws; ++k) soils[k].pressure.n *= 1.0 + 1e-4 * k;
  const std::vector<double> angles(kDraws, 0.4);
  const std::vector<WheelMotion> motions(kDraws, {0.85, 0.05});
  std::vector<WheelForces> forces(kDraws);
  for (auto _ : state) {
    wheel_forces(all ? kGrouserWheel : kWheel, soils, angles, motions, forces);
    benchmark::DoNotOptimize(forces.data());
  }
  state.SetItemsProcessed(state.iterations() * kDraws);
  state.counters["per_sample"] =
      benchmark::Counter(kDraws, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
  state.SetLabel(wheel_kernel().instruction_set);
}
BENCHMARK(BM_WheelForcesOverDraws)->ArgName("effects")->Arg(0)->Arg(1);

// The same as the balance of a rover asks for it, again and again: the soils' numbers are made once, and each
// time the wheels have another entry angle.
void BM_WheelNumbersOverDraws(benchmark::State& state) {
  constexpr int kDraws = 1024;
  const bool all = state.range(0) != 0;
  Soil soil = all ? every_effect() : sandy_loam();
  std::vector<WheelNumbers> wheels;
  for (int k = 0; k < kDraws; ++k) {
    soil.pressure.n *= 1.0 + 1e-4;
    wheels.push_back(numbers_of(all ? kGrouserWheel : kWheel, soil, 0.4, {0.85, 0.05}));
  }
  std::vector<WheelForces> forces(kDraws);
  for (auto _ : state) {
    for (WheelNumbers& wheel : wheels) wheel.theta_f = wheel.theta_f > 0.45 ? 0.35 : wheel.theta_f + 1e-6;
    wheel_forces(wheels, forces);
    benchmark::DoNotOptimize(forces.data());
  }
  state.counters["per_sample"] =
      benchmark::Counter(kDraws, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
  state.SetLabel(wheel_kernel().instruction_set);
}
BENCHMARK(BM_WheelNumbersOverDraws)->ArgName("effects")->Arg(0)->Arg(1);

// The machine's limit for the above: the exponentials and logarithms alone that one wheel needs, packed by
// the same library over the same number of wheels: arg 0 eight powers and two shears at sixteen nodes (40
// exp, 8 log), arg 1 with the crust besides and one shear in place of two (32 exp, 8 log).
void BM_ExponentialsOfOneWheel(benchmark::State& state) {
  const int exps = state.range(0) != 0 ? 32 : 40;
  const std::string_view set = wheel_kernel().instruction_set;
  PackedExponentials* const best = set.starts_with("avx512") ? packed_exponentials_avx512
                                   : set == "sse2"           ? packed_exponentials_sse2
                                                             : packed_exponentials_avx2;
  constexpr std::size_t kLanes = 1024;
  alignas(64) static double x[kLanes], y[kLanes];
  for (std::size_t k = 0; k < kLanes; ++k) x[k] = 0.1 + 1e-4 * static_cast<double>(k);
  for (auto _ : state) {
    best(x, y, kLanes, exps, 8);
    benchmark::DoNotOptimize(y);
  }
  state.counters["per_sample"] =
      benchmark::Counter(kLanes, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
BENCHMARK(BM_ExponentialsOfOneWheel)->ArgName("effects")->Arg(0)->Arg(1);

void BM_SixWheelStation(benchmark::State& state) {
  const bool all = state.range(1) != 0;
  RoverModel rover = six_wheeler();
  for (WheelModel& wheel : rover.wheels) {
    if (!all) continue;
    wheel.grousers = kGrouserWheel.grousers;
    wheel.rim_friction = kGrouserWheel.rim_friction;
  }
  QuasiStaticSolver solver(rover, 3.71);
  const Soil soil = all ? every_effect() : sandy_loam();
  const bool warm = state.range(0) != 0;
  int k = 0;
  for (auto _ : state) {
    ++k;
    const Stance stance = stance_on_plane(rover, {0.1 * std::sin(0.05 * k), 0.2 * std::sin(0.03 * k), 0.0});
    if (!warm) solver.reset();
    benchmark::DoNotOptimize(solver.solve(stance, soil, {.speed_m_s = 0.04}));
  }
}
BENCHMARK(BM_SixWheelStation)->ArgNames({"warm", "effects"})->ArgsProduct({{1, 0}, {0, 1}});

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
