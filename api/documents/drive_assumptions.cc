#include "api/documents/drive_assumptions.h"

#include "api/documents/model_object.h"
#include "api/files/effect_settings.h"
#include "api/files/failed_wheels.h"

namespace slipway::api::json {
namespace {

constexpr NumberRule kMapMetres{"m", -1e8, 1e8};
constexpr std::uint64_t kMaxExactWhole = 9'007'199'254'740'991;  // 2^53 - 1

void read_limits(ObjectReader& reader, sim::DriveLimits& limits) {
  auto object = reader.object("limits", kOptional);
  if (!object) return;
  object->number("max_slip", kOptional, {"1", 0.0, 1.0, true}, limits.max_slip_ratio);
  object->angle_deg("max_tilt_deg", kOptional, {"deg", 0.0, 60.0, true}, limits.max_tilt_rad);
  object->number("max_current_a", kOptional, {"A", 0.0, 100.0, true}, limits.max_current_a);
  object->number("max_sinkage_m", kOptional, {"m", 0.0, 1.0, true}, limits.max_sinkage_m);
  object->number("min_clearance_m", kOptional, {"m", 0.0, 2.0}, limits.min_clearance_m);
  object->refuse_unknown();
}

}  // namespace

void read_drive_assumptions(ObjectReader& reader, DriveAssumptions& drive) {
  read_limits(reader, drive.limits);
  read_effects(reader, drive.effects);
  read_failed_wheels(reader, drive.failed_wheels);
  reader.whole("draws", kOptional, 1, RequestLimits::kDraws, drive.draws);
  reader.whole("seed", kOptional, std::uint64_t{0}, kMaxExactWhole, drive.seed);
  reader.number("speed_m_s", kOptional, {"m/s", RequestLimits::kMinSpeed_m_s, 10.0}, drive.speed_m_s);
  reader.number("motor_temp_c", kOptional, {"degC", -150.0, 150.0}, drive.conditions.motor_temp_c);
  read_whole_model(reader, drive.model);
}

void write_drive_assumptions(Writer& w, const DriveAssumptions& drive) {
  w.key("limits").begin_object();
  w.exact("max_slip", drive.limits.max_slip_ratio);
  w.angle_deg("max_tilt_deg", drive.limits.max_tilt_rad);
  w.exact("max_current_a", drive.limits.max_current_a);
  w.exact("max_sinkage_m", drive.limits.max_sinkage_m);
  w.exact("min_clearance_m", drive.limits.min_clearance_m);
  w.end_object();
  write_effects(w, drive.effects);
  if (!drive.failed_wheels.empty()) {
    w.key("failed_wheels").begin_object();
    for (const auto& [wheel, failure] : drive.failed_wheels) w.text(wheel, sim::describe(failure));
    w.end_object();
  }
  w.whole("draws", drive.draws);
  w.whole("seed", static_cast<std::int64_t>(drive.seed));
  if (drive.speed_m_s) w.exact("speed_m_s", *drive.speed_m_s);
  if (drive.conditions.motor_temp_c) w.exact("motor_temp_c", *drive.conditions.motor_temp_c);
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

void read_names(ObjectReader& reader, std::string& terrain, std::string& rover) {
  const TextRule name{.most = 64, .is_name = true};
  reader.text("terrain", kRequired, name, terrain);
  reader.text("rover", kRequired, name, rover);
}

}  // namespace slipway::api::json
