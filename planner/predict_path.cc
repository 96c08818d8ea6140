#include "planner/predict_path.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "core/angle.h"
#include "planner/judge/advice.h"
#include "planner/judge/deciding_draws.h"
#include "planner/judge/drive_verdict.h"
#include "planner/judge/route_stations.h"
#include "planner/judge/verify_route.h"
#include "planner/problem/motion.h"
#include "planner/problem/terrain_ground.h"
#include "planner/search/plan_faults.h"
#include "planner/timing/departures.h"

namespace slipway::planner {
namespace {

// The motions, and for each the corner that it leads to.
struct CornerPath {
  std::vector<Motion> motions;
  std::vector<std::size_t> corner;
};

CornerPath join(const std::vector<Waypoint>& corners, const Manner& manner) {
  CornerPath path;
  // Motions are joined by their direction of travel.
  double heading = manner.travel(corners.front().yaw_rad.value_or(0.0));
  if (!corners.front().yaw_rad && corners.size() > 1) {
    heading = straight({corners[0].x_m, corners[0].y_m, 0.0}, corners[1].x_m, corners[1].y_m).to.yaw_rad;
  }
  Pose2 at{corners.front().x_m, corners.front().y_m, wrapped_rad(heading)};
  for (std::size_t i = 1; i < corners.size(); ++i) {
    Motion motion = straight(at, corners[i].x_m, corners[i].y_m);
    if (corners[i].yaw_rad) {
      const double last = manner.travel(*corners[i].yaw_rad);
      motion.last_turn_rad = wrapped_rad(last - motion.to.yaw_rad);
      motion.to.yaw_rad = wrapped_rad(last);
    }
    at = motion.to;
    path.motions.push_back(motion);
    path.corner.push_back(i);
  }
  if (path.motions.empty()) {
    path.motions.push_back({.from = at, .to = at});
    path.corner.push_back(0);
  }
  return path;
}

std::vector<sim::PathStation> stations_of(const PlanProblem& problem, const std::vector<Motion>& motions,
                                          const Manner& manner) {
  auto stations = route_stations(motions, sim::max_station_spacing_m(*problem.rover));
  for (sim::PathStation& station : stations) {
    station.pose.yaw_rad = manner.body_yaw(station.pose.yaw_rad);
    station.backwards = manner.backwards;
    station.crab_rad = manner.crab_rad;
  }
  return stations;
}

Result<sim::DrivePrediction> predict_stations(const PlanProblem& problem,
                                              const std::vector<sim::PathStation>& stations,
                                              Progress& progress) {
  return sim::predict_drive(
      *problem.rover, problem.gravity_m_s2, TerrainGround(problem.terrain, problem.soil_map), problem.beliefs,
      stations, problem.limits, risk_of_drive(problem.risk, stations.back().distance_m, stations.size()),
      problem.threads, progress, problem.conditions);
}

// "/stations/12" to the corner on the way to which it lies.
std::string corner_pointer(const CornerPath& path, const std::vector<sim::PathStation>& stations,
                           const std::string& pointer) {
  const std::string_view prefix = "/stations/";
  if (pointer.compare(0, prefix.size(), prefix) != 0) return pointer;
  const std::size_t station = std::stoul(pointer.substr(prefix.size()));
  if (station >= stations.size()) return pointer;
  double driven = 0.0;
  for (std::size_t i = 0; i < path.motions.size(); ++i) {
    driven += path.motions[i].length_m;
    if (stations[station].distance_m <= driven + 1e-9) return fmt::format("/path/{}", path.corner[i]);
  }
  return fmt::format("/path/{}", path.corner.back());
}

}  // namespace

Result<sim::DrivePrediction> predict_path(const PlanProblem& problem, const std::vector<Waypoint>& corners,
                                          Progress& progress, const Manner& manner) {
  if (corners.empty())
    return fail(ErrorCode::kInvalidRequest, "a path has at least one corner",
                {{"/path", "no corners, must be at least 1"}});
  const TerrainGround ground(problem.terrain, problem.soil_map);
  std::vector<Fault> faults;
  std::optional<ErrorCode> code;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const auto wrong = check_place(problem, ground, corners[i], 0.0, fmt::format("/path/{}", i), faults);
    if (wrong && code != ErrorCode::kOffMap) code = wrong;
  }
  if (code) {
    std::string detail = fmt::format("the path leaves the ground: {}", faults.front().message);
    return fail(*code, std::move(detail), std::move(faults));
  }

  const CornerPath path = join(corners, manner);
  const auto stations = stations_of(problem, path.motions, manner);
  Result<sim::DrivePrediction> drive = predict_stations(problem, stations, progress);
  if (!drive) {
    Error error = drive.error();
    for (Fault& fault : error.faults) fault.pointer = corner_pointer(path, stations, fault.pointer);
    return fail(std::move(error));
  }
  return drive;
}

std::vector<Motion> path_motions(const std::vector<Waypoint>& corners, const Manner& manner) {
  return join(corners, manner).motions;
}

Result<sim::DrivePrediction> predict_motions(const PlanProblem& problem, const std::vector<Motion>& motions,
                                             Progress& progress, const Manner& manner) {
  return predict_stations(problem, stations_of(problem, motions, manner), progress);
}

DriveVerdict judge_motions(const PlanProblem& problem, const std::vector<Motion>& motions,
                           const Manner& manner, const sim::DrivePrediction& prediction,
                           const DynamicVerification* dynamic, Progress& progress) {
  DriveVerdict verdict = judge_drive(problem, prediction, {.motions = &motions, .dynamic = dynamic});
  add_departures(problem, prediction, verdict, progress);
  auto shorter = shorter_drive(problem, stations_of(problem, motions, manner), prediction, verdict, progress);
  advise({std::move(shorter), scout_drive(problem, prediction, verdict)}, prediction.draws, verdict);
  return verdict;
}

void watch_as_past_drives(sim::DriveLimits& limits, sim::SlipChecks& checks) {
  limits.max_side_slip_rad = limits.max_aside_m = sim::kNoLimit;
  checks.slip_check_every_m = std::min(checks.slip_check_every_m, kPastLook_m);
}

Result<void> condition_draws(const PlanProblem& problem, const std::vector<Waypoint>& corners,
                             const sim::PastDriveReport& report, Progress& progress,
                             std::vector<sim::ConditionedDraw>& draws) {
  const TerrainGround ground(problem.terrain, problem.soil_map);
  // Slip checks average over metres: every third station does.
  const auto stations =
      route_stations(join(corners, {}).motions, 3.0 * sim::max_station_spacing_m(*problem.rover));
  sim::DriveLimits limits = problem.limits;
  sim::RiskOptions risk = problem.risk;
  watch_as_past_drives(limits, risk.checks);
  return sim::condition_draws(*problem.rover, problem.gravity_m_s2, ground, problem.beliefs, stations, limits,
                              risk, report, problem.threads, progress, draws, problem.conditions);
}

Result<DynamicVerification> verify_path(const PlanProblem& problem, const std::vector<Waypoint>& corners,
                                        const sim::DrivePrediction& prediction, Progress& progress,
                                        const Manner& manner) {
  return verify_route(problem, join(corners, manner).motions, manner, prediction, progress);
}

}  // namespace slipway::planner
