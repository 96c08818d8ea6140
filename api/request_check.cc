#include "api/request_check.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "api/departure_setting.h"
#include "api/files/relief_values.h"
#include "api/json/faults.h"
#include "api/json/json_value.h"
#include "dem/body_degrees.h"
#include "planner/search/plan_faults.h"
#include "sim/effects/effect_catalogue.h"
#include "sim/rover/drive_command.h"
#include "sky/mars_time.h"

namespace slipway::api {
RequestCheck::RequestCheck(const Catalogue& catalogue, std::vector<Fault> reader_faults)
    : catalogue_(catalogue) {
  for (Fault& fault : reader_faults) faults_.emplace_back(ErrorCode::kInvalidRequest, std::move(fault));
}

void RequestCheck::add(ErrorCode code, std::string pointer, std::string message) {
  faults_.emplace_back(code, Fault{std::move(pointer), std::move(message)});
}

bool RequestCheck::already_faulty(std::string_view pointer) const {
  return std::any_of(faults_.begin(), faults_.end(),
                     [&](const auto& entry) { return has_fault_under({entry.second}, pointer); });
}

void RequestCheck::names(const std::string& terrain, const std::string& rover) {
  if (!already_faulty("/terrain")) {
    const auto found = catalogue_.terrains.find(terrain);
    if (found != catalogue_.terrains.end()) {
      site_ = found->second.get();
    } else {
      add(ErrorCode::kInvalidRequest, "/terrain", unknown_terrain(catalogue_, terrain));
    }
  }
  if (!already_faulty("/rover")) {
    const auto found = catalogue_.rovers.find(rover);
    if (found != catalogue_.rovers.end()) {
      rover_ = found->second.get();
    } else {
      add(ErrorCode::kInvalidRequest, "/rover", unknown_rover(catalogue_, rover));
    }
  }
}

void RequestCheck::ground(const std::optional<RequestedModel>& model,
                          const std::vector<std::string>& of_service) {
  const std::string place = model ? "/model/ground" : "/ground";
  if (site_ == nullptr || already_faulty(place)) return;
  std::vector<std::string> there;
  for (const Legend& legend : site_->description().legends)
    for (const dem::SoilClass& row : legend.classes)
      if (row.soil && std::find(there.begin(), there.end(), *row.soil) == there.end())
        there.push_back(*row.soil);
  const std::vector<std::string>& named = model ? model->ground : of_service;
  for (std::size_t i = 0; i < named.size(); ++i)
    if (std::find(there.begin(), there.end(), named[i]) == there.end())
      add(ErrorCode::kInvalidRequest, fmt::format("{}/{}", place, i),
          fmt::format("{} is no soil of this terrain: {}", in_quotes(named[i]), fmt::join(there, ", ")));
}

void RequestCheck::legs(const PlanRequest& request) {
  // Of places that were not read it would say nonsense.
  for (const std::string_view place : {"/start", "/goal", "/waypoints"})
    if (already_faulty(place)) return;
  for (Fault& fault : planner::faults_of_legs(request.start, request.waypoints, request.goal))
    add(ErrorCode::kInvalidRequest, std::move(fault.pointer), std::move(fault.message));
}

void RequestCheck::place(const planner::Waypoint& place, const std::string& pointer) {
  if (site_ == nullptr || already_faulty(pointer)) return;
  const dem::Extent map = site_->info().geometry.extent();
  if (!map.contains(place.x_m, place.y_m)) {
    add(ErrorCode::kOffMap, pointer,
        fmt::format("({}, {}) m is off the map, must be in x [{}, {}] m and y [{}, {}] m{}", place.x_m,
                    place.y_m, map.west_m, map.east_m, map.south_m, map.north_m,
                    dem::likely_mistake(site_->info().crs_wkt, site_->info().body, map,
                                        {place.x_m, place.y_m}, false)));
    return;
  }
  const auto ground = site_->read_around(place.x_m, place.y_m, 0.0);
  if (!ground) {
    add(ground.error().code, pointer, ground.error().detail);
  } else if (!(*ground)->surface(place.x_m, place.y_m)) {
    add(ErrorCode::kNoData, pointer,
        fmt::format("({}, {}) m has no elevation: the terrain is not known there", place.x_m, place.y_m));
  }
}

void RequestCheck::zones(const std::vector<planner::Polygon>& zones, std::string_view pointer) {
  if (site_ == nullptr || already_faulty(pointer)) return;
  const dem::Extent map = site_->info().geometry.extent();
  for (std::size_t i = 0; i < zones.size(); ++i) {
    Eigen::AlignedBox2d box;
    for (const Eigen::Vector2d& corner : zones[i]) box.extend(corner);
    const Eigen::AlignedBox2d all(Eigen::Vector2d(map.west_m, map.south_m),
                                  Eigen::Vector2d(map.east_m, map.north_m));
    if (box.isEmpty() || box.intersects(all)) continue;
    const Eigen::Vector2d corner = zones[i].front();
    const std::string meant =
        dem::likely_mistake(site_->info().crs_wkt, site_->info().body, map, {corner.x(), corner.y()}, false);
    if (!meant.empty())
      add(ErrorCode::kOffMap, fmt::format("{}/{}", pointer, i), fmt::format("lies off the map{}", meant));
  }
}

// Of the soils that the drive may meet.
void RequestCheck::doubled_closures(const DriveAssumptions& drive) {
  std::set<std::string> met{drive.unknown_soil};
  if (const Legend* legend = site_ != nullptr ? site_->description().legend(drive.legend) : nullptr)
    for (const dem::SoilClass& row : legend->classes) met.insert(row.soil.value_or(""));
  for (const std::string& name : met)
    if (const auto soil = catalogue_.soils.find(name); soil != catalogue_.soils.end())
      for (Fault& fault : moved_under("/effects", sim::doubled(drive.effects, soil->second.mean, name)))
        add(ErrorCode::kInvalidRequest, fault.pointer, std::move(fault.message));
}

void RequestCheck::drive(const DriveAssumptions& drive) {
  if (!drive.unknown_soil.empty() && !already_faulty("/unknown_soil") &&
      !catalogue_.soils.contains(drive.unknown_soil))
    add(ErrorCode::kInvalidRequest, "/unknown_soil", unknown_soil(catalogue_, drive.unknown_soil));
  if (site_ != nullptr && !already_faulty("/legend") &&
      site_->description().legend(drive.legend) == nullptr) {
    std::vector<std::string> known;
    for (const Legend& legend : site_->description().legends) known.push_back(legend.name);
    add(ErrorCode::kInvalidRequest, "/legend", unknown_name("legend", drive.legend, known));
  }
  for (Fault& fault : moved_under("/effects", sim::faults_of(drive.effects))) {
    const std::string at = fault.pointer;
    if (!already_faulty(at)) add(ErrorCode::kInvalidRequest, at, std::move(fault.message));
  }
  if (rover_ != nullptr && !already_faulty("/effects")) {
    for (Fault& fault : moved_under("/effects", sim::faults_of(drive.effects, *rover_)))
      add(ErrorCode::kInvalidRequest, fault.pointer, std::move(fault.message));
  }
  if (rover_ != nullptr && !already_faulty("/effects")) {
    sim::RoverModel changed = *rover_;
    sim::apply_effects(sim::in_force(rover_->effects, drive.effects), changed);
    for (const Fault& fault : sim::faults_of(changed)) {
      add(ErrorCode::kInvalidRequest, "/effects", "the rover with these effects: " + fault.message);
    }
  }
  if (!already_faulty("/effects")) doubled_closures(drive);
  if (rover_ != nullptr && drive.conditions.motor_temp_c && !already_faulty("/effects")) {
    if (const auto fault = temperature_without_effect(*rover_, drive.effects))
      add(ErrorCode::kInvalidRequest, fault->pointer, fault->message);
  }
  relief(drive);
  departure(drive);
  if (rover_ != nullptr) failed_wheels(drive);
  drive_so_far(drive);
  if (rover_ == nullptr || !drive.speed_m_s || already_faulty("/speed_m_s")) return;
  const double fastest = rover_->drive.max_wheel_rate_rad_s * rover_->smallest_wheel_radius_m();
  if (*drive.speed_m_s > fastest) {
    add(ErrorCode::kInvalidRequest, "/speed_m_s",
        fmt::format("speed_m_s = {} m/s, must be in [{:g}, {:.6g}]: the motors of {} turn no faster",
                    *drive.speed_m_s, RequestLimits::kMinSpeed_m_s, fastest, rover_->name));
  }
}

void RequestCheck::departure(const DriveAssumptions& drive) {
  if (!drive.departure) return;
  const DepartureRequest& of = *drive.departure;
  if (site_ != nullptr && of.table.empty() && !already_faulty("/departure/sky")) {
    if (const auto why = why_no_sky(*site_))
      add(ErrorCode::kInvalidRequest, "/departure/sky",
          *why + ": give it as a table of moments, each with at, sun_azimuth_deg and sun_elevation_deg");
    else
      computed_sky(of);
  }
  if (site_ != nullptr && site_->info().body == "Moon" && of.optical_depth > 0.0)
    add(ErrorCode::kInvalidRequest, "/departure/optical_depth",
        "is of an atmosphere, which the Moon has not: leave it out");
  if (rover_ == nullptr || rover_->power) return;
  for (const auto& [given, key] : {std::pair{of.rules.min_charge.has_value(), "min_charge_percent"},
                                   {of.charge != 1.0, "charge_percent"},
                                   {of.optical_depth != 0.0, "optical_depth"}})
    if (given && !already_faulty(fmt::format("/departure/{}", key)))
      add(ErrorCode::kInvalidRequest, fmt::format("/departure/{}", key),
          fmt::format("the file of {} has no power, of which a charge could be told", rover_->name));
  if (of.air && !already_faulty("/departure/air") && !rover_->drive.thermal_resistance_k_w)
    add(ErrorCode::kInvalidRequest, "/departure/air",
        fmt::format(
            "the file of {} has neither power with heaters nor a thermal_resistance_k_w of its motors",
            rover_->name));
}

// Sun and Earth are computed at the departures.
void RequestCheck::computed_sky(const DepartureRequest& departure) {
  for (const auto& [at_ms, key] : {std::pair{departure.from_ms, "from"}, {departure.to_ms, "to"}}) {
    const std::string pointer = fmt::format("/departure/{}", key);
    auto why = sky::why_not_known(at_ms);
    if (!why || already_faulty(pointer)) continue;
    add(ErrorCode::kInvalidRequest, pointer, *std::move(why));
    if (departure.to_ms == departure.from_ms) return;
  }
}

void RequestCheck::failed_wheels(const DriveAssumptions& drive) {
  std::vector<std::string> known;
  for (const sim::WheelModel& wheel : rover_->wheels) known.push_back(wheel.name);
  for (const auto& [name, failure] : drive.failed_wheels)
    if (std::find(known.begin(), known.end(), name) == known.end())
      add(ErrorCode::kInvalidRequest, json::child_pointer("/failed_wheels", name),
          unknown_name("wheel", name, known));
}

// The rows' places and wheels.
void RequestCheck::relief(const DriveAssumptions& drive) {
  const Legend* const legend = site_ != nullptr ? site_->description().legend(drive.legend) : nullptr;
  if (!drive.relief || legend == nullptr || already_faulty("/relief")) return;
  const auto drawn = relief_spread(site_->description().relief, *drive.relief, *legend, nullptr);
  if (!drawn)
    add(ErrorCode::kInvalidRequest, "/relief",
        fmt::format(
            "has nothing to draw: the terrain {} states no relief; give elevation_error_m, roughness_m or "
            "rock_share",
            site_->description().name));
  else if (drawn->rock_share > 0.0 && drawn->max_rock_m <= drawn->min_rock_m)
    add(ErrorCode::kInvalidRequest, "/relief/max_rock_m",
        fmt::format("max_rock_m = {} m, must be more than min_rock_m = {} m", drawn->max_rock_m,
                    drawn->min_rock_m));
}

void RequestCheck::drive_so_far(const DriveAssumptions& drive) {
  if (!drive.drive_so_far || already_faulty("/drive_so_far")) return;
  std::vector<std::string> known;
  if (rover_ != nullptr)
    for (const sim::WheelModel& wheel : rover_->wheels) known.push_back(wheel.name);
  for (std::size_t k = 0; k < drive.drive_so_far->rows.size(); ++k) {
    const planner::TelemetryRow& row = drive.drive_so_far->rows[k];
    const std::string pointer = fmt::format("/drive_so_far/rows/{}", k);
    place({row.x_m, row.y_m, {}}, pointer);
    if (rover_ == nullptr) continue;
    for (const auto& [wheel, current_a] : row.currents_a)
      if (std::find(known.begin(), known.end(), wheel) == known.end())
        add(ErrorCode::kInvalidRequest, json::child_pointer(pointer + "/currents_a", wheel),
            unknown_name("wheel", wheel, known));
  }
}

void RequestCheck::crab(double crab_rad, bool among_zones) {
  if (rover_ == nullptr || already_faulty("/crab_deg")) return;
  if (auto why = sim::why_no_crab(*rover_, crab_rad))
    add(ErrorCode::kInvalidRequest, "/crab_deg", std::move(*why));
  else if (among_zones && crab_rad != 0.0)
    add(ErrorCode::kInvalidRequest, "/crab_deg",
        "must be 0 with keep_out or keep_in: what the body sweeps is known of drives along its own axis "
        "alone");
}

void RequestCheck::planners(const std::vector<std::string>& planners,
                            std::span<const planner::PlannerRow> known_rows) {
  std::vector<std::string> known;
  for (const planner::PlannerRow& row : known_rows) known.emplace_back(row.name);
  for (std::size_t i = 0; i < planners.size(); ++i) {
    const std::string pointer = fmt::format("/planners/{}", i);
    const auto begin = planners.begin();
    if (std::find(known.begin(), known.end(), planners[i]) == known.end()) {
      add(ErrorCode::kInvalidRequest, pointer, unknown_name("planner", planners[i], known));
    } else if (std::find(begin, begin + static_cast<std::ptrdiff_t>(i), planners[i]) !=
               begin + static_cast<std::ptrdiff_t>(i)) {
      add(ErrorCode::kInvalidRequest, pointer,
          fmt::format("planner {} is given twice", in_quotes(planners[i])));
    }
  }
}

void RequestCheck::path_length(const std::vector<planner::Waypoint>& path) {
  if (already_faulty("/path")) return;
  double length = 0.0;
  for (std::size_t i = 1; i < path.size(); ++i) {
    length += std::hypot(path[i].x_m - path[i - 1].x_m, path[i].y_m - path[i - 1].y_m);
  }
  if (length > RequestLimits::kPathLength_m) {
    add(ErrorCode::kInvalidRequest, "/path",
        fmt::format("path is {:.6g} m long, must be at most {}", length, RequestLimits::kPathLength_m));
  }
}

Error RequestCheck::error() const {
  Error error{faults_.front().first, "", {}};
  for (const auto& [code, fault] : faults_) {
    if (code != error.code) error.code = ErrorCode::kInvalidRequest;
    error.faults.push_back(fault);
  }
  error.detail = summary_of(error.faults);
  return error;
}

}  // namespace slipway::api
