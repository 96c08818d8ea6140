// The cost of the risk's draws on real relief with the service's beliefs: a drive of 300 m along the places
// where Curiosity stopped, per station and draw, and as a ratio to one exact balance of the same stations on
// the mean soils.

#include <benchmark/benchmark.h>

#include <cmath>
#include <ctime>
#include <vector>

#include "bench/gale_site.h"
#include "planner/judge/route_stations.h"
#include "planner/problem/terrain_ground.h"
#include "sim/prediction/drive_prediction.h"

namespace {

using namespace slipway;           // NOLINT: a program, not a header
using namespace slipway::planner;  // NOLINT

constexpr double kLength_m = 300.0;

// Straight from stop to stop, up to kLength_m.
std::vector<sim::PathStation> path_of(const bench::Site& site) {
  std::vector<Motion> motions;
  double length = 0.0;
  Pose2 at{site.stops[1].x_m, site.stops[1].y_m, 0.0};
  at.yaw_rad = std::atan2(site.stops[2].y_m - at.y_m, site.stops[2].x_m - at.x_m);
  for (std::size_t i = 2; i < site.stops.size() && length < kLength_m; ++i) {
    if (std::hypot(site.stops[i].x_m - at.x_m, site.stops[i].y_m - at.y_m) < 5.0) continue;
    const Motion motion = straight(at, site.stops[i].x_m, site.stops[i].y_m);
    motions.push_back(motion);
    at = motion.to;
    length += motion.length_m;
  }
  return route_stations(motions, sim::max_station_spacing_m(*site.problem.rover));
}

// Of the processor: others may be at work on the machine.
double seconds() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

void BM_DrawsOfADrive(benchmark::State& state) {
  const bench::Site site = bench::gale();
  const PlanProblem& p = site.problem;
  const TerrainGround ground(p.terrain, p.soil_map);
  const std::vector<sim::PathStation> stations = path_of(site);
  NoProgress progress;
  sim::RiskOptions none, some;
  none.draws = 0;
  some.draws = static_cast<int>(state.range(0));
  const auto predict = [&](const sim::RiskOptions& risk) {
    const double start = seconds();
    const auto drive = sim::predict_drive(*p.rover, p.gravity_m_s2, ground, p.beliefs, stations, p.limits,
                                          risk, 1, progress);
    if (!drive) std::abort();
    return seconds() - start;
  };
  double on_means = 0.0, with_draws = 0.0;
  for (auto _ : state) {
    on_means += predict(none);
    with_draws += predict(some);
  }
  const double one = 1e6 / (static_cast<double>(stations.size()) * static_cast<double>(state.iterations()));
  const double per_draw_us = (with_draws - on_means) * one / static_cast<double>(some.draws);
  state.counters["stations"] = static_cast<double>(stations.size());
  state.counters["us_per_station_and_draw"] = per_draw_us;
  state.counters["over_an_exact_balance"] = per_draw_us / (on_means * one);
}
BENCHMARK(BM_DrawsOfADrive)->Arg(96)->Arg(272)->Unit(benchmark::kMillisecond);

}  // namespace
