#include "api/service_drives.h"

#include <fmt/format.h>

#include <utility>

#include "api/documents/check_request.h"
#include "api/documents/plan_request.h"
#include "api/documents/prediction_request.h"
#include "api/service_setting.h"
#include "planner/judge/drive_verdict.h"
#include "planner/make_plan.h"
#include "planner/predict_path.h"
#include "planner/search/stage_progress.h"

namespace slipway::api {
namespace {

// The corners, or the start of a command sequence alone.
template <class Request>
void check_path(const Request& request, RequestCheck& check, bool is_start = false) {
  for (std::size_t i = 0; i < request.path.size(); ++i)
    check.place(request.path[i], is_start ? "/start" : fmt::format("/path/{}", i));
  check.path_length(request.path);
  check.zones(request.keep_out, "/keep_out");
  check.zones(request.keep_in, "/keep_in");
  check.crab(request.manner.crab_rad, !request.keep_out.empty() || !request.keep_in.empty());
}

// What of the terrain's measured slip lies near a drive.
std::optional<StepsNear> measured_near(const TerrainSite& site, const DriveAssumptions& drive,
                                       const sim::DrivePrediction& prediction) {
  std::vector<Pose2> way;
  for (const sim::StationPrediction& station : prediction.stations) way.push_back(station.station.pose);
  return steps_near(site.steps(), drive.as_of_sol, way);
}

// After the work it is known which tiles of a large terrain were looked at, and whether all could be read.
Result<void> account_for_tiles(const dem::Terrain& terrain, Provenance& provenance) {
  if (const auto damage = terrain.damage()) return fail(*damage);
  if (terrain.is_read_by_tiles()) provenance.terrain_fingerprint = terrain.fingerprint();
  return {};
}

Result<PlanAnswer> plan_within(const Service& service, const std::optional<dem::Extent>& window,
                               const PlanRequest& request, const std::vector<planner::Waypoint>& places,
                               Progress& progress) {
  auto setting = set_up(service, request.terrain, request.rover, places, request.drive, progress, window);
  if (!setting) return fail(setting.error());
  planner::PlanProblem& problem = setting->problem;
  problem.start = request.start;
  problem.goal = request.goal;
  problem.start_error = request.start_error;
  problem.waypoints = request.waypoints;
  problem.keep_out = request.keep_out;
  problem.keep_in = request.keep_in;
  problem.weights = request.weights;
  problem.ranking = request.ranking;
  problem.routes = request.routes;
  problem.verify = request.verify;
  problem.planners = request.planners;
  // Of many draws that a drive so far has left the first rank the candidates.
  if (request.drive.drive_so_far) problem.ranking_draws = kWeighedDraws;
  auto plan = planner::make_plan(problem, progress, service.options().planners);
  if (!plan) return fail(plan.error());
  if (auto whole = account_for_tiles(*problem.terrain, setting->provenance); !whole)
    return fail(whole.error());
  if (!plan->routes.empty())
    setting->provenance.measured_near =
        measured_near(*setting->site, request.drive, plan->routes.front().prediction);
  return PlanAnswer{request, std::move(setting->provenance), std::move(*plan)};
}

}  // namespace

Result<PlanRequest> read_plan(const Service& service, std::string_view json) {
  return checked(service, json::read_plan_request(json, service.options().costs),
                 [&](const PlanRequest& request, RequestCheck& check) {
                   check.place(request.start, "/start");
                   check.place(request.goal, "/goal");
                   for (std::size_t i = 0; i < request.waypoints.size(); ++i)
                     check.place(request.waypoints[i], fmt::format("/waypoints/{}", i));
                   check.legs(request);
                   check.zones(request.keep_out, "/keep_out");
                   check.zones(request.keep_in, "/keep_in");
                   check.planners(request.planners, service.options().planners);
                 });
}

Result<PredictionRequest> read_prediction(const Service& service, std::string_view json) {
  return checked(service, json::read_prediction_request(json),
                 [](const PredictionRequest& request, RequestCheck& check) { check_path(request, check); });
}

Result<CheckRequest> read_check(const Service& service, std::string_view json) {
  return checked(service, json::read_check_request(json, service.catalogue()->rules),
                 [](const CheckRequest& request, RequestCheck& check) {
                   check_path(request, check, !request.commands.empty());
                 });
}

Result<PlanAnswer> run_plan(const Service& service, const PlanRequest& request, Progress& progress) {
  progress.report("reading the terrain", 0.0);
  std::vector<planner::Waypoint> places{request.start, request.goal};
  places.insert(places.end(), request.waypoints.begin(), request.waypoints.end());
  auto planned = plan_within(service, std::nullopt, request, places, progress);
  if (planned && planned->plan.needs_wider_terrain)
    planned =
        plan_within(service, service.catalogue()->terrains.at(request.terrain)->info().geometry.extent(),
                    request, places, progress);
  return planned;
}

Result<PredictionAnswer> run_prediction(const Service& service, const PredictionRequest& request,
                                        Progress& progress) {
  progress.report("reading the terrain", 0.0);
  if (request.path.size() < 2) {
    return fail(ErrorCode::kInvalidRequest, "a path has at least two corners",
                {{"/path", "must have two corners"}});
  }
  auto setting = set_up(service, request.terrain, request.rover, request.path, request.drive, progress);
  if (!setting) return fail(setting.error());
  planner::PlanProblem& problem = setting->problem;
  problem.start = request.path.front();
  problem.goal = request.path.back();
  problem.keep_out = request.keep_out;
  problem.keep_in = request.keep_in;
  auto prediction = planner::predict_path(problem, request.path, progress, request.manner);
  if (!prediction) return fail(prediction.error());
  PredictionAnswer answer{request, {}, std::move(*prediction), std::nullopt, {}};
  if (request.level == FidelityLevel::kDynamic) {
    planner::StageProgress stage(progress, "verifying by dynamics", 0.3, 1.0);
    auto dynamic = planner::verify_path(problem, request.path, answer.prediction, stage, request.manner);
    if (!dynamic) return fail(dynamic.error());
    answer.dynamic = std::move(*dynamic);
  }
  answer.decision =
      planner::judge_motions(problem, planner::path_motions(request.path, request.manner), request.manner,
                             answer.prediction, answer.dynamic ? &*answer.dynamic : nullptr, progress);
  if (auto whole = account_for_tiles(*problem.terrain, setting->provenance); !whole)
    return fail(whole.error());
  setting->provenance.measured_near = measured_near(*setting->site, request.drive, answer.prediction);
  answer.provenance = std::move(setting->provenance);
  return answer;
}

Result<CheckAnswer> run_check(const Service& service, const CheckRequest& request, Progress& progress) {
  progress.report("reading the terrain", 0.0);
  const std::vector<planner::Motion> motions =
      request.commands.empty()
          ? planner::path_motions(request.path, request.manner)
          : planner::command_motions({request.path.front().x_m, request.path.front().y_m,
                                      request.manner.travel(request.path.front().yaw_rad.value_or(0.0))},
                                     request.commands);
  std::vector<planner::Waypoint> places;
  for (const planner::Motion& motion : motions) {
    places.push_back({motion.from.x_m, motion.from.y_m, {}});
    places.push_back({motion.to.x_m, motion.to.y_m, {}});
  }
  auto setting = set_up(service, request.terrain, request.rover, places, request.drive, progress);
  if (!setting) return fail(setting.error());
  setting->problem.keep_out = request.keep_out;
  setting->problem.keep_in = request.keep_in;
  auto prediction = planner::predict_motions(setting->problem, motions, progress, request.manner);
  if (!prediction) return fail(prediction.error());
  planner::DriveVerdict decision =
      planner::judge_motions(setting->problem, motions, request.manner, *prediction, nullptr, progress);
  if (auto whole = account_for_tiles(*setting->problem.terrain, setting->provenance); !whole)
    return fail(whole.error());
  setting->provenance.measured_near = measured_near(*setting->site, request.drive, *prediction);
  return CheckAnswer{request, std::move(setting->provenance), std::move(*prediction), std::move(decision)};
}

}  // namespace slipway::api
