#include "api/documents/drive_so_far.h"

#include <fmt/format.h>

#include "api/documents/drive_series.h"
#include "api/json/faults.h"
#include "core/angle.h"

namespace slipway::api::json {
namespace {

constexpr NumberRule kMapMetres{"m", -1e8, 1e8};
constexpr NumberRule kCurrent{"A", 0.0, 1000.0};
constexpr std::size_t kMaxRows = 5000, kMaxWheels = 20;

void read_currents(ObjectReader& row, planner::TelemetryRow& out) {
  const JsonValue* const currents = row.member("currents_a", kOptional);
  if (currents == nullptr) return;
  ObjectReader by_wheel(*currents, child_pointer(row.pointer(), "currents_a"), row.faults());
  if (!by_wheel.is_object()) return;
  if (currents->keys.size() > kMaxWheels) {
    row.fault("currents_a", fmt::format("there must be {} wheels at most", kMaxWheels));
    return;
  }
  for (const std::string& wheel : currents->keys) {
    double current_a = 0.0;
    if (by_wheel.number(wheel, kRequired, kCurrent, current_a)) out.currents_a[wheel] = current_a;
  }
  if (out.current_a) row.fault("currents_a", "current_a and currents_a exclude each other");
}

void read_row(const Element& element, planner::DriveSoFar& drive, std::vector<Fault>& faults) {
  ObjectReader row(*element.value, element.pointer, faults);
  planner::TelemetryRow& out = drive.rows.emplace_back();
  row.number("time_s", kOptional, {"s", -1e12, 1e12}, out.time_s);
  row.number("driven_m", kRequired, {"m", 0.0, 1e6}, out.driven_m);
  row.number("x_m", kRequired, kMapMetres, out.x_m);
  row.number("y_m", kRequired, kMapMetres, out.y_m);
  row.angle_deg("yaw_deg", kOptional, {"deg", -360.0, 360.0}, out.yaw_rad);
  row.number("current_a", kOptional, kCurrent, out.current_a);
  read_currents(row, out);
  row.refuse_unknown();
}

}  // namespace

void read_drive_so_far(ObjectReader& reader, std::optional<planner::DriveSoFar>& out) {
  const std::size_t before = reader.faults().size();
  auto object = reader.object("drive_so_far", kOptional);
  if (!object) return;
  planner::DriveSoFar drive;
  object->number("position_noise_m", kOptional, {"m", 0.0, 10.0, true}, drive.position_noise_m);
  object->number("current_noise_a", kOptional, {"A", 0.0, 100.0}, drive.current_noise_a);
  for (const Element& element : object->list("rows", kRequired, {2, kMaxRows}))
    read_row(element, drive, reader.faults());
  object->refuse_unknown();
  if (reader.faults().size() == before)
    for (const Fault& fault : planner::faults_of(drive))
      reader.faults().push_back({object->pointer() + fault.pointer, fault.message});
  out = std::move(drive);
}

void write_drive_so_far(Writer& w, const planner::DriveSoFar& drive) {
  w.key("drive_so_far").begin_object().exact("position_noise_m", drive.position_noise_m);
  w.exact("current_noise_a", drive.current_noise_a).key("rows").begin_array();
  for (const planner::TelemetryRow& row : drive.rows) {
    w.begin_object();
    if (row.time_s) w.exact("time_s", *row.time_s);
    w.exact("driven_m", row.driven_m).exact("x_m", row.x_m).exact("y_m", row.y_m);
    if (row.yaw_rad) w.angle_deg("yaw_deg", *row.yaw_rad);
    if (row.current_a) w.exact("current_a", *row.current_a);
    if (!row.currents_a.empty()) {
      w.key("currents_a").begin_object();
      for (const auto& [wheel, current_a] : row.currents_a) w.exact(wheel, current_a);
      w.end_object();
    }
    w.end_object();
  }
  w.end_array().end_object();
}

void write_learnt_drive(Writer& w, const std::optional<LearntDrive>& learnt, const DriveAssumptions& drive) {
  if (!learnt) return;
  w.key("drive_so_far").begin_object().whole("draws", learnt->draws);
  w.significant("effective_draws", learnt->effective_draws).key("stretches").begin_array();
  for (const planner::LearntStretch& each : learnt->stretches) {
    const planner::TelemetryRow& end = drive.drive_so_far->rows[each.stretch.rows.back()];
    w.begin_object().metres("from_m", each.stretch.from_m).metres("to_m", each.stretch.to_m);
    w.metres("x_m", end.x_m).metres("y_m", end.y_m);
    w.metres("come_m", each.stretch.measured.come_m);
    w.significant("slip", each.stretch.measured.slip_ratio());
    write_spread(w, "predicted_slip", each.forecast.slip_ratio);
    w.end_object();
  }
  w.end_array().end_object();
}

}  // namespace slipway::api::json
