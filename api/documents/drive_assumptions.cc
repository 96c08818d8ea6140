#include "api/documents/drive_assumptions.h"

#include "api/documents/departure.h"
#include "api/documents/drive_so_far.h"
#include "api/documents/model_object.h"
#include "api/files/effect_settings.h"
#include "api/files/failed_wheels.h"
#include "api/files/relief_values.h"
#include "api/files/soil_file.h"
#include "core/largest_exact_whole.h"

namespace slipway::api::json {
namespace {

constexpr NumberRule kMapMetres{"m", -1e8, 1e8};

}  // namespace

void read_drive_assumptions(ObjectReader& reader, DriveAssumptions& drive) {
  read_drive_rules(reader, drive);
  read_effects(reader, drive.effects);
  read_failed_wheels(reader, drive.failed_wheels);
  int draws = 0;
  if (reader.whole("draws", kOptional, 1, RequestLimits::kDraws, draws)) drive.draws = draws;
  int sol = 0;
  if (reader.whole("as_of_sol", kOptional, 0, RequestLimits::kMaxSol, sol)) drive.as_of_sol = sol;
  read_drive_so_far(reader, drive.drive_so_far);
  drive.beliefs = read_soils(reader, "beliefs", kOptional);
  read_relief(reader, drive.relief);
  reader.text("unknown_soil", kOptional, {.most = 64, .is_name = true}, drive.unknown_soil);
  reader.number("confidence", kOptional, {"1", 0.0, 1.0, true}, drive.confidence);
  reader.text("legend", kOptional, {.most = 64, .is_name = true}, drive.legend);
  reader.whole("seed", kOptional, std::uint64_t{0}, kMaxExactWhole, drive.seed);
  reader.number("speed_m_s", kOptional, {"m/s", RequestLimits::kMinSpeed_m_s, 10.0}, drive.speed_m_s);
  reader.number("segment_m", kOptional, {"m", RequestLimits::kMinSegment_m, RequestLimits::kPathLength_m},
                drive.segment_m);
  reader.number("motor_temp_c", kOptional, {"degC", -150.0, 150.0}, drive.conditions.motor_temp_c);
  read_departure(reader, drive.departure);
  read_whole_model(reader, drive.model);
}

void write_drive_assumptions(Writer& w, const DriveAssumptions& drive) {
  write_drive_rules(w, drive);
  write_effects(w, drive.effects);
  if (!drive.failed_wheels.empty()) {
    w.key("failed_wheels").begin_object();
    for (const auto& [wheel, failure] : drive.failed_wheels) w.text(wheel, sim::describe(failure));
    w.end_object();
  }
  if (drive.draws) w.whole("draws", *drive.draws);
  if (drive.as_of_sol) w.whole("as_of_sol", *drive.as_of_sol);
  if (drive.drive_so_far) write_drive_so_far(w, *drive.drive_so_far);
  if (!drive.beliefs.empty()) {
    w.key("beliefs").begin_array();
    for (const sim::SoilDistribution& soil : drive.beliefs) write_soil(w, soil);
    w.end_array();
  }
  if (drive.relief) write_relief(w, *drive.relief);
  if (!drive.unknown_soil.empty()) w.text("unknown_soil", drive.unknown_soil);
  if (drive.confidence) w.exact("confidence", *drive.confidence);
  if (!drive.legend.empty()) w.text("legend", drive.legend);
  w.whole("seed", static_cast<std::int64_t>(drive.seed));
  if (drive.speed_m_s) w.exact("speed_m_s", *drive.speed_m_s);
  if (drive.segment_m) w.exact("segment_m", *drive.segment_m);
  if (drive.conditions.motor_temp_c) w.exact("motor_temp_c", *drive.conditions.motor_temp_c);
  if (drive.departure) write_departure(w, *drive.departure);
  if (drive.model) write_model_reference(w.key("model"), *drive.model);
}

void read_waypoint(const JsonValue& value, const std::string& pointer, planner::Waypoint& out,
                   std::vector<Fault>& faults) {
  ObjectReader reader(value, pointer, faults);
  reader.number("x_m", kRequired, kMapMetres, out.x_m);
  reader.number("y_m", kRequired, kMapMetres, out.y_m);
  reader.angle_deg("yaw_deg", kOptional, {"deg", -360.0, 360.0}, out.yaw_rad);
  reader.refuse_unknown();
}

void write_waypoint(Writer& w, const planner::Waypoint& waypoint) {
  w.begin_object().exact("x_m", waypoint.x_m).exact("y_m", waypoint.y_m);
  if (waypoint.yaw_rad) w.angle_deg("yaw_deg", *waypoint.yaw_rad);
  w.end_object();
}

std::optional<planner::Waypoint> place_reached(const DriveAssumptions& drive) {
  if (!drive.drive_so_far || drive.drive_so_far->rows.empty()) return std::nullopt;
  const planner::TelemetryRow& last = drive.drive_so_far->rows.back();
  return planner::Waypoint{last.x_m, last.y_m, last.yaw_rad};
}

void go_on_from_place_reached(const DriveAssumptions& drive, std::vector<planner::Waypoint>& path) {
  const auto place = place_reached(drive);
  if (place && path.size() == 1) path.insert(path.begin(), *place);
}

void read_names(ObjectReader& reader, std::string& terrain, std::string& rover) {
  const TextRule name{.most = 64, .is_name = true};
  reader.text("terrain", kRequired, name, terrain);
  reader.text("rover", kRequired, name, rover);
}

}  // namespace slipway::api::json
