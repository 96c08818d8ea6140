#include "api/files/drive_table/campaign_documents.h"
#include "api/json/faults.h"
#include "api/json/parse.h"
#include "api/json/strict_reader.h"
#include "core/angle.h"

namespace slipway::api::json {
namespace {

constexpr NumberRule kAny{};

void write_pose(Writer& w, std::string_view key, const Pose2& pose) {
  w.key(key).begin_object().exact("x_m", pose.x_m).exact("y_m", pose.y_m);
  w.exact("yaw_deg", deg_from_rad(pose.yaw_rad)).end_object();
}

void read_pose(ObjectReader& reader, std::string_view key, Pose2& pose) {
  auto object = reader.object(key, kRequired);
  if (!object) return;
  object->number("x_m", kRequired, kAny, pose.x_m);
  object->number("y_m", kRequired, kAny, pose.y_m);
  object->angle_deg("yaw_deg", kRequired, kAny, pose.yaw_rad);
}

void write_exact_peak(Writer& w, std::string_view key, const sim::Peak& peak, double unit = 1.0) {
  w.key(key).begin_object().exact("value", unit * peak.value).exact("at_m", peak.distance_m).end_object();
}

void read_peak(ObjectReader& reader, std::string_view key, sim::Peak& peak, double unit = 1.0) {
  auto object = reader.object(key, kRequired);
  if (!object) return;
  object->number("value", kRequired, kAny, peak.value);
  object->number("at_m", kRequired, kAny, peak.distance_m);
  peak.value *= unit;
}

void write_soil_that_was(Writer& w, const sim::Soil& soil) {
  w.begin_object().exact("k_c", soil.pressure.k_c).exact("k_phi", soil.pressure.k_phi);
  w.exact("n", soil.pressure.n).exact("cohesion_pa", soil.cohesion_pa);
  w.exact("friction_angle_deg", deg_from_rad(soil.friction_angle_rad));
  w.exact("shear_modulus_x_m", soil.shear_modulus_x_m).exact("shear_modulus_y_m", soil.shear_modulus_y_m);
  w.end_object();
}

void write_answer(Writer& w, const campaign::DriveRecord& record) {
  w.exact("duration_s", record.duration_s).exact("progress_m", record.progress_m);
  w.exact("commanded_m", record.commanded_m).exact("energy_j", record.energy_j);
  w.exact("final_slip_ratio", record.final_slip_ratio);
  write_pose(w, "start", record.start);
  write_pose(w, "final", record.final);
  write_pose(w, "commanded", record.commanded);
  write_exact_peak(w, "max_slip_ratio", record.max_slip_ratio);
  write_exact_peak(w, "max_tilt_deg", record.max_tilt_rad, deg_from_rad(1.0));
  write_exact_peak(w, "max_current_a", record.max_current_a);
  write_exact_peak(w, "max_sinkage_m", record.max_sinkage_m);
  w.key("events").begin_array();
  for (const sim::DriveEvent& event : record.events) {
    w.begin_object().text("kind", sim::describe(event.kind)).exact("t_s", event.time_s);
    if (event.wheel >= 0) w.whole("wheel", event.wheel);
    if (event.leg >= 0) w.whole("leg", event.leg);
    w.end_object();
  }
  w.end_array().key("work").begin_object().whole("steps", record.work.steps);
  w.whole("evaluations", record.work.evaluations).whole("jacobians", record.work.jacobians);
  w.whole("restarts", record.work.restarts).end_object();
}

void read_answer(ObjectReader& reader, campaign::DriveRecord& record) {
  reader.number("duration_s", kRequired, kAny, record.duration_s);
  reader.number("progress_m", kRequired, kAny, record.progress_m);
  reader.number("commanded_m", kRequired, kAny, record.commanded_m);
  reader.number("energy_j", kRequired, kAny, record.energy_j);
  reader.number("final_slip_ratio", kRequired, kAny, record.final_slip_ratio);
  read_pose(reader, "start", record.start);
  read_pose(reader, "final", record.final);
  read_pose(reader, "commanded", record.commanded);
  read_peak(reader, "max_slip_ratio", record.max_slip_ratio);
  read_peak(reader, "max_tilt_deg", record.max_tilt_rad, rad_from_deg(1.0));
  read_peak(reader, "max_current_a", record.max_current_a);
  read_peak(reader, "max_sinkage_m", record.max_sinkage_m);
}

}  // namespace

std::string drive_record_document(const campaign::DriveRecord& record) {
  Writer w;
  w.begin_object().text("format", "drive-outcome/1").text("id", record.id).text("digest", record.digest);
  w.text("end", record.end).text("reason", record.reason).boolean("answered", record.answered);
  w.texts("files", record.files);
  w.key("soils").begin_object();
  for (const auto& [name, soil] : record.soils) write_soil_that_was(w.key(name), soil);
  w.end_object();
  if (record.answered) write_answer(w, record);
  w.end_object();
  return w.take() + "\n";
}

Result<campaign::DriveRecord> read_drive_record(std::string_view bytes) {
  const auto document = parse(bytes, {.bytes = 64U << 20U, .values = 4'000'000});
  if (!document) return fail(document.error());
  campaign::DriveRecord record;
  std::vector<Fault> faults;
  ObjectReader reader(*document, "", faults);
  std::size_t format = 0;
  reader.choice("format", kRequired, {"drive-outcome/1"}, format);
  reader.text("id", kRequired, {.most = 1000}, record.id);
  reader.text("digest", kRequired, {}, record.digest);
  reader.text("end", kRequired, {}, record.end);
  reader.text("reason", kRequired, {.most = 100'000, .may_be_empty = true}, record.reason);
  reader.boolean("answered", kRequired, record.answered);
  reader.texts("files", kRequired, {0, 1000}, {.most = 1000}, record.files);
  if (record.answered) read_answer(reader, record);
  if (!faults.empty()) return fail(ErrorCode::kUnreadableData, summary_of(faults), faults);
  return record;
}

}  // namespace slipway::api::json
