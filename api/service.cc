#include "api/service.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "api/documents/check_request.h"
#include "api/documents/diagnosis/diagnosis_request.h"
#include "api/documents/diagnosis/watch_request.h"
#include "api/documents/drive_assumptions.h"
#include "api/documents/plan_request.h"
#include "api/documents/prediction_request.h"
#include "api/documents/soil/soil_estimate_request.h"
#include "api/files/campaign/drive_campaign_source.h"
#include "api/files/model_folder.h"
#include "api/json/faults.h"
#include "api/maps/map_documents.h"
#include "api/request_check.h"
#include "gap/diagnosis/reference_diagnosis.h"
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

}  // namespace

Result<std::unique_ptr<Service>> Service::open(ServiceOptions options) {
  auto catalogue = load_catalogue(options.data, *options.soil_format);
  if (!catalogue) return fail(catalogue.error());
  if (!options.model.empty()) {
    const auto folder = load_model_folder(options.model);
    if (!folder) return fail(folder.error());
    catalogue = with_model(*std::move(catalogue), *folder, options.ground);
    if (!catalogue) return fail(catalogue.error());
  }
  std::unique_ptr<Service> service(new Service(std::move(options)));
  service->catalogue_ = std::make_shared<const Catalogue>(std::move(*catalogue));
  service->shipped_ = shipped_campaigns(service->options_.data, *service->catalogue_);
  for (const ShippedCampaign& campaign : service->shipped_) service->campaigns_.push_back(campaign.name);
  return service;
}

std::shared_ptr<const Catalogue> Service::catalogue_for(const DriveAssumptions& drive, std::string& rover,
                                                        std::vector<Fault>& faults) const {
  std::shared_ptr<const Catalogue> catalogue = catalogue_of(drive.model, rover, faults);
  if (drive.beliefs.empty() || has_fault_under(faults, "/beliefs")) return catalogue;
  auto with = with_soils(*catalogue, drive.beliefs);
  if (!with) {
    for (const Fault& fault : with.error().faults) faults.push_back(fault);
    return catalogue;
  }
  return std::make_shared<const Catalogue>(*std::move(with));
}

std::shared_ptr<const Catalogue> Service::catalogue_of(const std::optional<RequestedModel>& model,
                                                       std::string& rover, std::vector<Fault>& faults) const {
  std::shared_ptr<const Catalogue> all = catalogue();
  if (!model) return all;
  auto with = with_model(*all, *model->corrected, model->ground);
  if (!with) {
    for (Fault& fault : moved_under("/model", with.error().faults)) faults.push_back(std::move(fault));
    return all;
  }
  if (rover == model->corrected->nominal_rover) rover = model->corrected->model.rover.name;
  if (rover != model->corrected->model.rover.name)
    for (Fault& fault : not_of_this_rover(*model->corrected, rover).faults)
      faults.push_back(std::move(fault));
  return std::make_shared<const Catalogue>(*std::move(with));
}

template <class Request, class Rest>
Result<Request> Service::checked(Result<Reading<Request>> reading, const Rest& rest) const {
  if (!reading) return fail(reading.error());
  Request& request = reading->request;
  const std::shared_ptr<const Catalogue> catalogue =
      catalogue_for(request.drive, request.rover, reading->faults);
  RequestCheck check(*catalogue, std::move(reading->faults));
  check.names(request.terrain, request.rover);
  check.ground(request.drive.model, options_.ground);
  rest(request, check);
  check.drive(request.drive);
  if (!check.passed()) return fail(check.error());
  return std::move(request);
}

Result<PlanRequest> Service::read_plan(std::string_view json) const {
  return checked(json::read_plan_request(json, options_.costs),
                 [this](const PlanRequest& request, RequestCheck& check) {
                   check.place(request.start, "/start");
                   check.place(request.goal, "/goal");
                   for (std::size_t i = 0; i < request.waypoints.size(); ++i)
                     check.place(request.waypoints[i], fmt::format("/waypoints/{}", i));
                   check.legs(request);
                   check.zones(request.keep_out, "/keep_out");
                   check.zones(request.keep_in, "/keep_in");
                   check.planners(request.planners, options_.planners);
                 });
}

Result<PredictionRequest> Service::read_prediction(std::string_view json) const {
  return checked(json::read_prediction_request(json),
                 [](const PredictionRequest& request, RequestCheck& check) { check_path(request, check); });
}

Result<CheckRequest> Service::read_check(std::string_view json) const {
  return checked(json::read_check_request(json, catalogue_->rules),
                 [](const CheckRequest& request, RequestCheck& check) {
                   check_path(request, check, !request.commands.empty());
                 });
}

Result<DiagnosisRequest> Service::read_diagnosis(std::string_view json) const {
  auto reading = json::read_diagnosis_request(json);
  if (!reading) return fail(reading.error());
  std::vector<Fault>& faults = reading->faults;
  check_campaign(reading->request.campaign, "/campaign", faults);
  if (!reading->request.reference.empty()) check_campaign(reading->request.reference, "/reference", faults);
  if (!faults.empty()) return fail(ErrorCode::kInvalidRequest, summary_of(faults), faults);
  return std::move(reading->request);
}

Result<ModelCheckRequest> Service::read_model_check(std::string_view json) const {
  auto reading = json::read_model_check_request(json);
  if (!reading) return fail(reading.error());
  std::vector<Fault>& faults = reading->faults;
  if (!has_fault_under(faults, "/campaign")) check_campaign(reading->request.campaign, "/campaign", faults);
  if (!faults.empty()) return fail(ErrorCode::kInvalidRequest, summary_of(faults), faults);
  return std::move(reading->request);
}

Result<WatchRequest> Service::read_watch(std::string_view json) const {
  auto reading = json::read_watch_request(json, [this](const std::string& name) { return drives_of(name); });
  if (!reading) return fail(reading.error());
  if (!reading->faults.empty())
    return fail(ErrorCode::kInvalidRequest, summary_of(reading->faults), reading->faults);
  return std::move(reading->request);
}

Result<SoilEstimateRequest> Service::read_soil_estimate(std::string_view json) const {
  auto reading = json::read_soil_estimate_request(json);
  if (!reading) return fail(reading.error());
  const SoilEstimateRequest& request = reading->request;
  std::vector<Fault>& faults = reading->faults;
  for (Fault& fault : faults_of(*catalogue(), request))
    if (!has_fault_under(faults, fault.pointer)) faults.push_back(std::move(fault));
  if (!request.campaign.empty()) check_campaign(request.campaign, "/campaign", faults);
  if (!faults.empty()) return fail(ErrorCode::kInvalidRequest, summary_of(faults), faults);
  return std::move(reading->request);
}

Result<MapRequest> Service::read_map(std::string_view json) const {
  return checked(
      json::read_map_request(json, options_.costs), [](const MapRequest& request, RequestCheck& check) {
        if (request.place)
          check.place(*request.place, request.kind == planner::MapKind::kCostToGo ? "/to" : "/from");
        check.zones(request.keep_out, "/keep_out");
        check.zones(request.keep_in, "/keep_in");
      });
}

Result<PlanAnswer> Service::plan(const PlanRequest& request, Progress& progress) const {
  progress.report("reading the terrain", 0.0);
  std::vector<planner::Waypoint> places{request.start, request.goal};
  places.insert(places.end(), request.waypoints.begin(), request.waypoints.end());
  auto planned = plan_within(std::nullopt, request, places, progress);
  if (planned && planned->plan.needs_wider_terrain)
    planned = plan_within(catalogue()->terrains.at(request.terrain)->info().geometry.extent(), request,
                          places, progress);
  return planned;
}

Result<PlanAnswer> Service::plan_within(const std::optional<dem::Extent>& window, const PlanRequest& request,
                                        const std::vector<planner::Waypoint>& places,
                                        Progress& progress) const {
  auto setting = set_up(request.terrain, request.rover, places, request.drive, progress, window);
  if (!setting) return fail(setting.error());
  planner::PlanProblem& problem = setting->problem;
  problem.start = request.start;
  problem.goal = request.goal;
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
  auto plan = planner::make_plan(problem, progress, options_.planners);
  if (!plan) return fail(plan.error());
  if (auto whole = account_for_tiles(*problem.terrain, setting->provenance); !whole)
    return fail(whole.error());
  if (!plan->routes.empty())
    setting->provenance.measured_near =
        measured_near(*setting->site, request.drive, plan->routes.front().prediction);
  return PlanAnswer{request, std::move(setting->provenance), std::move(*plan)};
}

Result<PredictionAnswer> Service::predict(const PredictionRequest& request, Progress& progress) const {
  progress.report("reading the terrain", 0.0);
  if (request.path.size() < 2) {
    return fail(ErrorCode::kInvalidRequest, "a path has at least two corners",
                {{"/path", "must have two corners"}});
  }
  auto setting = set_up(request.terrain, request.rover, request.path, request.drive, progress);
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

Result<CheckAnswer> Service::check(const CheckRequest& request, Progress& progress) const {
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
  auto setting = set_up(request.terrain, request.rover, places, request.drive, progress);
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

Result<DiagnosisAnswer> Service::diagnose(const DiagnosisRequest& request, Progress& progress) const {
  progress.report("reading the drives", 0.0);
  auto campaign = drives_of(request.campaign);
  if (!campaign) return fail(campaign.error());
  gap::DiagnosisOptions options;
  options.search.withheld = request.without;
  options.search.threads = options_.threads;
  options.seed = request.seed;
  if (!request.reference.empty()) {
    const auto reference = drives_of(request.reference);
    if (!reference) return fail(reference.error());
    auto since = gap::diagnose_since(*reference, *campaign, options, progress);
    if (!since) return fail(since.error());
    return DiagnosisAnswer{request, std::move(*campaign), std::move(*since)};
  }
  auto diagnosis = gap::diagnose(*campaign, options, progress);
  if (!diagnosis) return fail(diagnosis.error());
  return DiagnosisAnswer{request, std::move(*campaign), std::move(*diagnosis)};
}

Result<ModelCheckAnswer> Service::check_model(const ModelCheckRequest& request, Progress& progress) const {
  progress.report("reading the drives", 0.0);
  const auto campaign = drives_of(request.campaign);
  if (!campaign) return fail(campaign.error());
  gap::ModelCheckOptions options;
  options.threads = options_.threads;
  options.seed = request.seed;
  return api::check_model(*campaign, *request.model->corrected, request.model->ground, options, progress);
}

Result<WatchAnswer> Service::watch(const WatchRequest& request, Progress& progress) const {
  gap::WatchOptions watch;
  watch.learn = request.learn;
  watch.change.alpha = request.alpha;
  watch.diagnose = request.diagnose;
  gap::DiagnosisOptions options;
  options.search.withheld = request.without;
  options.search.threads = options_.threads;
  options.seed = request.seed;
  auto watched = gap::watch_drives(request.watched, request.healthy.get(), watch, options, progress);
  if (!watched) return fail(watched.error());
  return WatchAnswer{*std::move(watched)};
}

Result<SoilEstimateAnswer> Service::estimate_soil(const SoilEstimateRequest& request,
                                                  Progress& progress) const {
  if (request.campaign.empty()) return api::estimate_soil(*catalogue(), request, progress);
  progress.report("reading the drives", 0.0);
  const auto campaign = drives_of(request.campaign);
  if (!campaign) return fail(campaign.error());
  return api::estimate_soil(*campaign, request, options_.threads, progress);
}

Result<GroundAt> Service::ground_at(std::string_view terrain, double x_m, double y_m) const {
  const std::shared_ptr<const Catalogue> all = catalogue();
  const auto found = all->terrains.find(terrain);
  if (found == all->terrains.end()) return fail(ErrorCode::kNotFound, unknown_terrain(*all, terrain));
  const TerrainSite& site = *found->second;
  RequestCheck check(*all, {});
  check.names(std::string(terrain), names_of(all->rovers).front());
  check.place({x_m, y_m, std::nullopt}, "");
  if (!check.passed()) return fail(check.error());
  const dem::GridGeometry& geometry = site.info().geometry;
  GroundAt at;
  at.x_m = x_m;
  at.y_m = y_m;
  // A wheelbase, or what the raster can tell.
  at.roughness_radius_m = std::max(1.5, 1.5 * std::max(geometry.cell_x_m, geometry.cell_y_m));
  const double reach = at.roughness_radius_m + 2.0 * std::max(geometry.cell_x_m, geometry.cell_y_m);
  const auto ground = site.read({x_m - reach, y_m - reach, x_m + reach, y_m + reach});
  if (!ground) return fail(ground.error());
  const auto surface = ground->terrain->surface(x_m, y_m);
  if (!surface) return fail(ErrorCode::kNoData, "the terrain has no elevation there");
  at.height_m = surface->height_m;
  at.slope_rad = surface->slope_rad();
  at.aspect_rad = surface->aspect_rad();
  at.roughness_m = ground->terrain->roughness_m(x_m, y_m, at.roughness_radius_m);
  if (const auto mapped = ground->soil_map->class_at(x_m, y_m)) {
    for (const dem::SoilClass& entry : ground->soil_map->legend()) {
      if (entry.value == *mapped) at.label = entry.label;
    }
  }
  if (const auto soil = ground->soil_map->soil_at(x_m, y_m)) at.soil = ground->soil_map->soils()[*soil];
  return at;
}

}  // namespace slipway::api
