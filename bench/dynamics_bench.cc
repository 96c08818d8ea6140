// The cost of the dynamic level per unit of work.
#include <benchmark/benchmark.h>

#include <cmath>
#include <ctime>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "dem/synthetic_terrain.h"
#include "planner/problem/terrain_ground.h"
#include "sim/dynamic/dynamic_drive.h"
#include "sim/dynamic/rut_map.h"
#include "sim/wheel/wheel_kernel.h"
#include "tests/sim/reference_models.h"
#include "tests/sim/reference_multibodies.h"

namespace slipway::sim {
namespace {

// State set, a force on every wheel, accelerations: what one evaluation of the equations asks of the tree.
void BM_MultibodyAccelerations(benchmark::State& state) {
  const Multibody rover = rocker_bogie_rover(static_cast<int>(state.range(0)), 0.3);
  MultibodyDynamics dynamics(rover);
  const int joints = rover.joint_count();
  std::vector<double> angles(joints, 0.1), rates(joints, 0.3), accelerations(joints);
  SpatialVector base = SpatialVector::Constant(0.05), base_acceleration;
  const Eigen::Matrix3d R_MB =
      Eigen::AngleAxisd(0.2, Eigen::Vector3d(1.0, 2.0, 2.0) / 3.0).toRotationMatrix();
  for (auto _ : state) {
    angles[0] += 1e-9;
    dynamics.set_state(R_MB, base, angles.data(), rates.data());
    for (int i = 0; i < joints; ++i) {
      if (!rover.bodies()[i].round) continue;
      dynamics.add_force(i, rover.bodies()[i].pivot_m, {10.0, 1.0, 100.0}, {0.0, 2.0, 0.0});
      dynamics.add_torque(i, 3.0);
    }
    dynamics.accelerations({0.0, 0.0, -3.71}, base_acceleration, accelerations.data());
    benchmark::DoNotOptimize(accelerations.data());
    benchmark::DoNotOptimize(base_acceleration.data());
  }
}
BENCHMARK(BM_MultibodyAccelerations)->Arg(4)->Arg(6);

// Six looks at a map that a rover has driven a few metres on.
void BM_RutsUnderSixWheels(benchmark::State& state) {
  RutMap ruts;
  for (const double y : {-0.6, 0.6}) ruts.press({-3.0, y}, {3.0, y}, 0.16, 0.03);
  double x = -2.0;
  for (auto _ : state) {
    x = x > 2.0 ? -2.0 : x + 1e-4;
    for (const double y : {-0.6, 0.6}) {
      for (const double axle : {-0.7, 0.0, 0.7}) benchmark::DoNotOptimize(ruts.at(x + axle, y));
    }
  }
  state.SetItemsProcessed(6 * state.iterations());
}
BENCHMARK(BM_RutsUnderSixWheels);

// A wheel presses a centimetre of ground.
void BM_PressRut(benchmark::State& state) {
  RutMap ruts;
  double x = -2.0;
  for (auto _ : state) {
    x = x > 2.0 ? -2.0 : x + 0.01;
    ruts.press({x, 0.3}, {x + 0.01, 0.302}, 0.16, 0.03);
  }
}
BENCHMARK(BM_PressRut);

// Processor time is measured: a drive is the work of one thread, and other load of the machine is not its
// cost.
double processor_s() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

// A rover of six wheels on an elevation raster of 5 cm cells with bumps of this height.
planner::TerrainGround rough_ground(double rms_m, double size_m) {
  const dem::Relief relief{.ripple = {},
                           .roughness = dem::Relief::Roughness{.rms_m = rms_m, .lattice_m = 0.5}};
  return {dem::make_relief({.size_m = size_m, .cell_m = 0.05}, relief), nullptr};
}

DriveSoils one_soil() {
  return {{sandy_loam()}, sandy_loam()};
}

DriveLeg straight_leg(double length_m) {
  DriveLeg leg;
  leg.command.speed_m_s = 0.04;
  leg.length_m = length_m;
  return leg;
}

// The law alone, for six wheels at once.
double law_s() {
  const RoverModel rover = six_wheeler();
  std::vector<WheelNumbers> wheels;
  for (const WheelModel& wheel : rover.wheels)
    wheels.push_back(numbers_of(wheel.geometry(), sandy_loam(), 0.4, {.forward = 0.85, .leftward = 0.02}));
  std::vector<WheelForces> forces(wheels.size());
  constexpr int kCalls = 20000;
  const auto start = processor_s();
  for (int call = 0; call < kCalls; ++call) {
    wheels[0].forward = 0.85 + 1e-6 * call;
    wheel_forces(wheels, forces);
    benchmark::DoNotOptimize(forces.data());
  }
  return (processor_s() - start) / kCalls;
}

// A drive of twenty metres with heading feedback. The arguments are the height of the bumps (mm, rms) and n
// of the tolerance 10^-n.
void BM_Drive(benchmark::State& state) {
  const RoverModel rover = six_wheeler();
  const planner::TerrainGround ground = rough_ground(1e-3 * static_cast<double>(state.range(0)), 30.0);
  DynamicOptions options;
  options.relative_tolerance = std::pow(10.0, -static_cast<double>(state.range(1)));
  options.feedback = Feedback::kPose;
  options.sample_interval_s = 10.0;
  const std::vector<DriveLeg> legs{straight_leg(20.0)};
  NoProgress progress;
  DynamicDrive drive;
  const auto run = [&] {
    return simulate_drive(rover, 3.71, ground, one_soil(), {-10.0, 0.0, 0.0}, legs, options, nullptr,
                          progress);
  };
  double simulated_s = 0.0;
  long evaluations = 0;
  const auto start = processor_s();
  for (auto _ : state) {
    drive = run().value();
    simulated_s += drive.duration_s;
    evaluations += drive.work.evaluations;
  }
  const double spent_s = (processor_s() - start);
  options.relative_tolerance = 1e-8;
  const DynamicDrive exact = run().value();
  state.counters["real_time_factor"] = simulated_s / spent_s;
  state.counters["us_per_m"] = 1e6 * spent_s / (20.0 * static_cast<double>(state.iterations()));
  state.counters["evaluations_per_m"] = static_cast<double>(drive.work.evaluations) / 20.0;
  state.counters["steps_per_m"] = static_cast<double>(drive.work.steps) / 20.0;
  state.counters["jacobians_per_m"] = static_cast<double>(drive.work.jacobians) / 20.0;
  state.counters["us_per_evaluation"] = 1e6 * spent_s / static_cast<double>(evaluations);
  state.counters["law_share"] = law_s() * static_cast<double>(evaluations) / spent_s;
  state.counters["end_error_mm"] =
      1e3 * std::hypot(drive.final.x_m - exact.final.x_m, drive.final.y_m - exact.final.y_m);
  state.counters["energy_error"] = std::abs(drive.energy_j / exact.energy_j - 1.0);
}
BENCHMARK(BM_Drive)
    ->ArgNames({"bumps_mm", "tolerance"})
    ->ArgsProduct({{0, 5, 20, 60}, {3}})
    ->ArgsProduct({{20}, {2, 4, 5, 6}})
    ->Unit(benchmark::kMillisecond);

double resident_kb() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("VmRSS:")) return std::stod(line.substr(6));
  return 0.0;
}

// A kilometre as fifty times twenty metres to and fro, over which the memory must not grow.
void BM_Kilometre(benchmark::State& state) {
  const RoverModel rover = six_wheeler();
  const planner::TerrainGround ground = rough_ground(0.02, 1100.0 / 16.0);
  DynamicOptions options;
  options.feedback = Feedback::kPose;
  options.sample_interval_s = 60.0;
  std::vector<DriveLeg> legs;
  DriveLeg turn;
  turn.command.turn_in_place = true;
  turn.command.turn_rate_rad_s = 0.03;
  turn.turn_rad = 3.14159265358979;
  for (int lap = 0; lap < 20; ++lap) {
    legs.push_back(straight_leg(50.0));
    legs.push_back(turn);
  }
  double after_a_tenth = 0.0, last = 0.0, simulated_s = 0.0;
  const auto start = processor_s();
  for (auto _ : state) {
    NoProgress progress;
    const auto sink = [&](const DriveSample& sample) {
      last = resident_kb();
      if (sample.progress_m < 100.0) after_a_tenth = last;
    };
    simulated_s +=
        simulate_drive(rover, 3.71, ground, one_soil(), {-25.0, 0.0, 0.0}, legs, options, sink, progress)
            ->duration_s;
  }
  state.counters["real_time_factor"] = simulated_s / (processor_s() - start);
  state.counters["growth_kB_after_100_m"] = last - after_a_tenth;
}
BENCHMARK(BM_Kilometre)->Iterations(1)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace slipway::sim
