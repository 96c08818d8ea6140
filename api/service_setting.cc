#include "api/service_setting.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "api/departure_setting.h"
#include "api/documents/drive_assumptions.h"
#include "api/files/model_folder.h"
#include "api/files/relief_values.h"
#include "api/ground_evidence.h"
#include "api/json/faults.h"
#include "api/requests/soil_regions.h"
#include "api/soil_beliefs.h"
#include "core/random.h"
#include "planner/judge/deciding_draws.h"

namespace slipway::api {
namespace {

// Cells from this size on don't show what lies under a rover.
constexpr double kLargeCell_m = 10.0;

// Enough for a search to go around what lies between the places.
dem::Extent window_around(const std::vector<planner::Waypoint>& places, const dem::GridGeometry& geometry) {
  dem::Extent box{places.front().x_m, places.front().y_m, places.front().x_m, places.front().y_m};
  for (const planner::Waypoint& place : places) {
    box.west_m = std::min(box.west_m, place.x_m);
    box.east_m = std::max(box.east_m, place.x_m);
    box.south_m = std::min(box.south_m, place.y_m);
    box.north_m = std::max(box.north_m, place.y_m);
  }
  constexpr double kMinMargin_m = 60.0;
  constexpr double kMarginRatio = 0.4;
  constexpr double kMinMarginCells = 8.0;
  const double size = std::max(box.east_m - box.west_m, box.north_m - box.south_m);
  const double margin = std::max(
      {kMinMargin_m, kMarginRatio * size, kMinMarginCells * std::max(geometry.cell_x_m, geometry.cell_y_m)});
  return {box.west_m - margin, box.south_m - margin, box.east_m + margin, box.north_m + margin};
}

// All that the ground under drives of the past depends on but the sol. Empty where a request brings a model
// of its own, whose numbers its name does not tell.
std::string conditions_of(const TerrainSite& terrain, const std::string& rover, DriveAssumptions drive,
                          int draws) {
  if (drive.model) return {};
  drive.as_of_sol.reset();
  drive.drive_so_far.reset();
  drive.departure.reset();
  drive.draws = draws;
  json::Writer w;
  w.begin_object().text("terrain", terrain.description().name).text("version", terrain.version());
  w.text("rover", rover);
  json::write_drive_assumptions(w, drive);
  w.end_object();
  return w.take();
}

// The soil that is assumed where no map names one.
std::string assumed_soil(const DriveAssumptions& drive, double gravity_m_s2) {
  return drive.unknown_soil.empty() ? std::string(unknown_ground_at(gravity_m_s2)) : drive.unknown_soil;
}

// What the map's soils and unknown ground are believed to be.
sim::SoilBeliefs beliefs_of(const Catalogue& catalogue, const DriveAssumptions& drive,
                            const std::vector<RegionalSoil>& soils, double confidence, double gravity_m_s2,
                            const std::vector<sim::EffectSetting>& effects) {
  sim::SoilBeliefs beliefs;
  const std::string unmapped(unknown_ground_at(gravity_m_s2));
  for (const RegionalSoil& soil : soils)
    beliefs.known.push_back(believed(
        catalogue, soil, soil.is_mapped ? drive.confidence.value_or(confidence) : 1.0, unmapped, effects));
  beliefs.unknown =
      believed(catalogue, {assumed_soil(drive, gravity_m_s2), {}, false}, 1.0, unmapped, effects);
  return beliefs;
}

Provenance provenance_of(const TerrainSite& site, const Legend& legend, const planner::PlanProblem& problem,
                         std::uint64_t seed) {
  Provenance provenance{.terrain_title = site.description().title,
                        .terrain_version = site.version(),
                        .terrain_fingerprint = problem.terrain->fingerprint(),
                        .crs_name = site.info().crs_name,
                        .body = site.info().body,
                        .gravity_m_s2 = site.description().gravity_m_s2,
                        .legend = legend.name,
                        .soil_assumption = legend.assumption,
                        .soils = {},
                        .unknown_soil = problem.beliefs.unknown.name,
                        .seed = seed};
  const dem::GridGeometry& cells = problem.terrain->geometry();
  if (const double cell_m = std::max(cells.cell_x_m, cells.cell_y_m); cell_m >= kLargeCell_m)
    provenance.unseen_relief = fmt::format(
        "between heights {:g} m apart the ground is taken as a plane: rocks, ripples, steps and slopes "
        "shorter than {:g} m are not in the map, and no limit of tilt, clearance or slip is held against "
        "them",
        cell_m, 3.0 * cell_m);
  // By what is believed of them: a corrected soil's name is another than the map's.
  for (const sim::SoilDistribution& belief : problem.beliefs.known) provenance.soils.push_back(belief.name);
  return provenance;
}

// All places of which the terrain is needed.
std::vector<planner::Waypoint> places_to_read(const TerrainSite& site, const DriveAssumptions& drive,
                                              std::vector<planner::Waypoint> places) {
  if (drive.as_of_sol) {
    const std::vector<planner::Waypoint> past = places_of({site.outcomes(), site.steps()}, *drive.as_of_sol);
    places.insert(places.end(), past.begin(), past.end());
  }
  if (drive.drive_so_far)
    for (const planner::TelemetryRow& row : drive.drive_so_far->rows)
      places.push_back({row.x_m, row.y_m, {}});
  return places;
}

// The service's own, or a copy with the request's model in it.
std::shared_ptr<const Catalogue> catalogue_of(const Service& service,
                                              const std::optional<RequestedModel>& model, std::string& rover,
                                              std::vector<Fault>& faults) {
  std::shared_ptr<const Catalogue> all = service.catalogue();
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

// Conditions the setting's draws on the drive under way.
Result<void> learn(const DriveAssumptions& drive, Progress& progress, DriveSetting& setting) {
  progress.report("conditioning the ground on the drive so far", 0.0);
  planner::PlanProblem& problem = setting.problem;
  std::vector<sim::ConditionedDraw> draws;
  if (problem.risk.conditioned)
    draws = *problem.risk.conditioned;
  else
    draws.resize(
        static_cast<std::size_t>(drive.draws.value_or(planner::draws_for(problem, *drive.drive_so_far))));
  auto stretches = planner::condition_on_drive(problem, *drive.drive_so_far, progress, draws);
  if (!stretches) return fail(stretches.error());
  setting.provenance.learnt =
      LearntDrive{std::move(*stretches), static_cast<int>(draws.size()), sim::effective_draws(draws)};
  const auto wanted = static_cast<std::size_t>(drive.draws.value_or(planner::kMostDraws));
  problem.risk.conditioned = std::make_shared<const std::vector<sim::ConditionedDraw>>(
      sim::renewed(draws, wanted, random_key(problem.risk.seed, wanted)));
  return {};
}

}  // namespace

std::shared_ptr<const Catalogue> catalogue_for(const Service& service, const DriveAssumptions& drive,
                                               std::string& rover, std::vector<Fault>& faults) {
  std::shared_ptr<const Catalogue> catalogue = catalogue_of(service, drive.model, rover, faults);
  if (drive.beliefs.empty() || has_fault_under(faults, "/beliefs")) return catalogue;
  auto with = with_soils(*catalogue, drive.beliefs);
  if (!with) {
    for (const Fault& fault : with.error().faults) faults.push_back(fault);
    return catalogue;
  }
  return std::make_shared<const Catalogue>(*std::move(with));
}

Result<DriveSetting> set_up(const Service& service, const std::string& terrain, const std::string& rover,
                            const std::vector<planner::Waypoint>& places, const DriveAssumptions& drive,
                            Progress& progress, const std::optional<dem::Extent>& window) {
  std::vector<Fault> faults;
  std::string driven_name = rover;
  const std::shared_ptr<const Catalogue> catalogue = catalogue_for(service, drive, driven_name, faults);
  RequestCheck check(*catalogue, std::move(faults));
  check.names(terrain, driven_name);
  check.drive(drive);
  if (!check.passed()) return fail(check.error());
  const std::shared_ptr<const TerrainSite> found = catalogue->terrains.find(terrain)->second;
  const TerrainSite& site = *found;
  sim::RoverModel driven = *catalogue->rovers.find(driven_name)->second;
  const std::vector<sim::EffectSetting> effects = sim::in_force(driven.effects, drive.effects);
  sim::apply_effects(effects, driven);
  sim::fail_wheels(driven, drive.failed_wheels, drive.conditions);
  if (drive.speed_m_s) driven.cruise_speed_m_s = *drive.speed_m_s;
  const Legend& legend = *site.description().legend(drive.legend);
  auto ground = site.read(
      window ? *window : window_around(places_to_read(site, drive, places), site.info().geometry), legend);
  if (!ground) return fail(ground.error());

  DriveSetting setting;
  setting.site = found;
  planner::PlanProblem& problem = setting.problem;
  problem.terrain = ground->terrain;
  problem.terrain_is_whole_map = problem.terrain->geometry() == site.info().geometry;
  const RegionalSoils soils = soils_in_regions(ground->soil_map, sim::effect_regions(effects),
                                               assumed_soil(drive, site.description().gravity_m_s2));
  problem.soil_map = soils.map;
  problem.beliefs =
      beliefs_of(*catalogue, drive, soils.soils, legend.confidence, site.description().gravity_m_s2, effects);
  problem.conditions = drive.conditions;
  problem.rover = std::make_shared<const sim::RoverModel>(std::move(driven));
  problem.gravity_m_s2 = site.description().gravity_m_s2;
  problem.limits = drive.limits;
  // The seed is that of the draws alone: the routes that are compared are the same under each.
  problem.risk.seed = drive.seed;
  problem.risk.draws = drive.draws.value_or(planner::kFirstDraws);
  problem.risk.max_draws = drive.draws ? 0 : planner::kMostDraws;
  problem.risk.checks = drive.checks;
  problem.risk.segment_m = drive.segment_m.value_or(0.0);
  problem.risk.bars = drive.bars;
  if (drive.relief)
    problem.risk.relief = relief_spread(site.description().relief, *drive.relief, legend, ground->soil_map);
  problem.threads = service.options().threads;

  setting.provenance = provenance_of(site, legend, problem, drive.seed);
  setting.provenance.relief = problem.risk.relief;
  if (drive.as_of_sol) {
    progress.report("conditioning the ground on drives of the past", 0.0);
    // Draws are conditioned on the past, and renewed to as many as a check takes at most.
    planner::PlanProblem past = problem;
    past.risk.draws = drive.draws.value_or(kWeighedDraws);
    const auto wanted = static_cast<std::size_t>(drive.draws.value_or(planner::kMostDraws));
    auto evidence =
        service.conditioned_ground().get(conditions_of(site, driven_name, drive, past.risk.draws), past,
                                         {site.outcomes(), site.steps()}, *drive.as_of_sol, wanted, progress);
    if (!evidence) return fail(evidence.error());
    problem.risk.conditioned = evidence->draws;
    setting.provenance.past_drives = evidence->drives;
    setting.provenance.measured_m = evidence->measured_m;
  }
  if (drive.departure) {
    auto departure = departure_of(site, problem.terrain, places.front(), *drive.departure);
    if (!departure) return fail(departure.error());
    problem.departure = std::move(*departure);
  }
  if (drive.drive_so_far)
    if (auto learnt = learn(drive, progress, setting); !learnt) return fail(learnt.error());
  return setting;
}

}  // namespace slipway::api
