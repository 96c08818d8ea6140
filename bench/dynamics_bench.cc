// Cost of the dynamic rung, per unit of work.
#include <benchmark/benchmark.h>

#include <vector>

#include "sim/rut_map.h"
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

}  // namespace
}  // namespace slipway::sim
