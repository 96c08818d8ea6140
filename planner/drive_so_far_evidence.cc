#include "planner/drive_so_far_evidence.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include "core/angle.h"
#include "core/random.h"
#include "planner/problem/terrain_ground.h"

namespace slipway::planner {
namespace {

// Draws of the ground under each stretch.
constexpr int kTries = 4;
// A measured slip is a mean over metres: every third of the stations that obstacles need tells it.
constexpr double kSpacings = 3.0;

std::vector<std::string> wheel_names(const PlanProblem& problem) {
  std::vector<std::string> names;
  for (const sim::WheelModel& wheel : problem.rover->wheels) names.push_back(wheel.name);
  return names;
}

double spacing_m(const PlanProblem& problem) {
  return kSpacings * sim::max_station_spacing_m(*problem.rover);
}

// Along places of the map, as straight lines.
std::vector<sim::PathStation> stations_along(const PlanProblem& problem, const std::vector<Waypoint>& along,
                                             bool backwards) {
  const double turned_rad = backwards ? rad_from_deg(180.0) : 0.0;
  std::vector<sim::PathStation> stations;
  double driven_m = 0.0;
  for (std::size_t k = 1; k < along.size(); ++k) {
    const Waypoint &a = along[k - 1], &b = along[k];
    const double length_m = std::hypot(b.x_m - a.x_m, b.y_m - a.y_m);
    const double yaw_rad = wrapped_rad(std::atan2(b.y_m - a.y_m, b.x_m - a.x_m) + turned_rad);
    const int pieces = std::max(1, static_cast<int>(std::ceil(length_m / spacing_m(problem))));
    for (int i = k == 1 ? 0 : 1; i <= pieces; ++i) {
      const double share = static_cast<double>(i) / pieces;
      stations.push_back({.pose = {a.x_m + share * (b.x_m - a.x_m), a.y_m + share * (b.y_m - a.y_m), yaw_rad},
                          .distance_m = driven_m + share * length_m,
                          .backwards = backwards});
    }
    driven_m += length_m;
  }
  return stations;
}

// Along the stretch's positions, as straight lines. A rover that hardly comes forward stands at the last one.
std::vector<sim::PathStation> stations_of(const PlanProblem& problem, const DriveSoFar& drive,
                                          const TelemetryStretch& stretch) {
  const TelemetryRow& begin = drive.rows[stretch.rows.front()];
  const TelemetryRow& end = drive.rows[stretch.rows.back()];
  const double turned_rad = stretch.backwards ? rad_from_deg(180.0) : 0.0;
  std::vector<sim::PathStation> stations;
  if (stretch.measured.come_m <= 2.0 * drive.position_noise_m) {
    const double travel = std::atan2(end.y_m - begin.y_m, end.x_m - begin.x_m);
    const double yaw_rad = end.yaw_rad.value_or(begin.yaw_rad.value_or(travel + turned_rad));
    stations.push_back({.pose = {end.x_m, end.y_m, wrapped_rad(yaw_rad)}, .backwards = stretch.backwards});
    return stations;
  }
  std::vector<Waypoint> along;
  for (const std::size_t row : stretch.rows) along.push_back({drive.rows[row].x_m, drive.rows[row].y_m, {}});
  return stations_along(problem, along, stretch.backwards);
}

// Leaves out the lightest draws, which together have less than a thousandth of the weight.
void drop_lightest(std::vector<sim::ConditionedDraw>& draws) {
  constexpr double kNegligible = 1e-3;
  constexpr std::size_t kMinLeft = 200;
  if (draws.size() <= kMinLeft) return;
  std::vector<double> weights;
  for (const sim::ConditionedDraw& draw : draws) weights.push_back(draw.weight);
  std::sort(weights.begin(), weights.end());
  const double all = std::accumulate(weights.begin(), weights.end(), 0.0);
  double dropped = 0.0, least = 0.0;
  for (std::size_t k = 0; k + kMinLeft < weights.size(); ++k) {
    dropped += weights[k];
    if (dropped > kNegligible * all) break;
    least = weights[k];
  }
  draws.erase(std::remove_if(draws.begin(), draws.end(),
                             [least](const sim::ConditionedDraw& draw) { return draw.weight <= least; }),
              draws.end());
}

// The weight c with which sum of min(weight / c, 1) is `count`; fewer draws than that have a weight.
double equal_weight(const std::vector<sim::ConditionedDraw>& draws, std::size_t count) {
  std::vector<double> weights;
  for (const sim::ConditionedDraw& draw : draws) weights.push_back(draw.weight);
  std::sort(weights.begin(), weights.end(), std::greater<>());
  double rest = std::accumulate(weights.begin(), weights.end(), 0.0);
  for (std::size_t heavy = 0; heavy < count; ++heavy) {
    const double c = rest / static_cast<double>(count - heavy);
    if (weights[heavy] <= c) return c;
    rest -= weights[heavy];
  }
  return weights[count - 1];
}

// Leaves `count` draws: those that weigh more than others share keep their weights, of the others each stays
// with a probability that goes with its weight, and then weighs as much as the next [Fearnhead & Clifford
// 2003].
void thin(std::vector<sim::ConditionedDraw>& draws, std::size_t count, std::uint64_t key) {
  if (draws.size() <= count) return;
  const double c = equal_weight(draws, count);
  double passed = random_uniform(key, 0);
  std::vector<sim::ConditionedDraw> left;
  for (sim::ConditionedDraw& draw : draws) {
    if (draw.weight < c) {
      passed += draw.weight / c;
      if (passed < 1.0) continue;
      passed -= 1.0;
      draw.weight = c;
    }
    left.push_back(std::move(draw));
  }
  draws = std::move(left);
}

}  // namespace

int draws_for(const PlanProblem& problem, const DriveSoFar& drive) {
  constexpr double kMaxBalances = 300'000.0;
  constexpr double kMinDraws = 300.0, kMaxDraws = 5000.0;
  double stations = 0.0;
  for (const TelemetryStretch& stretch : stretches_of(drive, wheel_names(problem)))
    stations += 2.0 + stretch.measured.come_m / spacing_m(problem);
  return static_cast<int>(std::clamp(kMaxBalances / (kTries * stations), kMinDraws, kMaxDraws));
}

Result<void> condition_on_way(const PlanProblem& problem, const MeasuredWay& way, int tries,
                              Progress& progress, std::vector<sim::ConditionedDraw>& draws) {
  const TerrainGround ground(problem.terrain, problem.soil_map);
  const auto done =
      sim::condition_on_stretch(*problem.rover, problem.gravity_m_s2, ground, problem.beliefs,
                                stations_along(problem, way.along, false), way.measured, {}, problem.risk,
                                tries, problem.threads, progress, draws, problem.conditions);
  if (!done) return fail(done.error());
  return {};
}

Result<std::vector<LearntStretch>> condition_on_drive(const PlanProblem& problem, const DriveSoFar& drive,
                                                      Progress& progress,
                                                      std::vector<sim::ConditionedDraw>& draws) {
  const TerrainGround ground(problem.terrain, problem.soil_map);
  const sim::TelemetryErrors errors{.position_m = drive.position_noise_m, .current_a = drive.current_noise_a};
  for (std::size_t d = 0; d < draws.size(); ++d) draws[d].number = draws[d].number.value_or(d);
  std::vector<LearntStretch> learnt;
  for (TelemetryStretch& stretch : stretches_of(drive, wheel_names(problem))) {
    auto forecast = sim::condition_on_stretch(
        *problem.rover, problem.gravity_m_s2, ground, problem.beliefs, stations_of(problem, drive, stretch),
        stretch.measured, errors, problem.risk, kTries, problem.threads, progress, draws, problem.conditions);
    if (!forecast) {
      Error error = forecast.error();
      for (Fault& fault : error.faults)
        fault.pointer = fmt::format("/drive_so_far/rows/{}", stretch.rows.back());
      return fail(std::move(error));
    }
    drop_lightest(draws);
    learnt.push_back({std::move(stretch), *forecast});
  }
  thin(draws, kMaxLearntDraws, random_key(problem.risk.seed, kMaxLearntDraws));
  return learnt;
}

}  // namespace slipway::planner
