#include "api/files/drive_rules.h"

#include "api/json/faults.h"
#include "api/json/parse.h"

namespace slipway::api::json {
namespace {

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

void read_checks(ObjectReader& reader, sim::SlipChecks& checks) {
  auto object = reader.object("checks", kOptional);
  if (!object) return;
  object->number("slip_check_every_m", kOptional, {"m", 0.0, 1000.0, true}, checks.slip_check_every_m);
  object->number("embedding_slip", kOptional, {"1", 0.0, 1.0, true}, checks.embedding_slip_ratio);
  object->number("embedding_turns", kOptional, {"1", 0.0, 1000.0}, checks.embedding_turns);
  object->number("embedding_sinkage_share", kOptional, {"1", 0.0, 1.0, true}, checks.embedding_sinkage_share);
  object->refuse_unknown();
}

void read_bars(ObjectReader& reader, sim::OutcomeBars& bars) {
  auto object = reader.object("bars", kOptional);
  if (!object) return;
  object->number("max_embedding", kOptional, {"1", 0.0, 1.0, true}, bars.max_embedding);
  object->number("max_expected_stops", kOptional, {"1", 0.0, 1000.0, true}, bars.max_expected_stops);
  object->refuse_unknown();
}

}  // namespace

void read_drive_rules(ObjectReader& reader, DriveRules& rules) {
  read_limits(reader, rules.limits);
  read_checks(reader, rules.checks);
  read_bars(reader, rules.bars);
}

void write_drive_rules(Writer& w, const DriveRules& rules) {
  w.key("limits").begin_object();
  w.exact("max_slip", rules.limits.max_slip_ratio);
  w.angle_deg("max_tilt_deg", rules.limits.max_tilt_rad);
  w.exact("max_current_a", rules.limits.max_current_a);
  w.exact("max_sinkage_m", rules.limits.max_sinkage_m);
  w.exact("min_clearance_m", rules.limits.min_clearance_m);
  w.end_object();
  w.key("checks").begin_object();
  w.exact("slip_check_every_m", rules.checks.slip_check_every_m);
  w.exact("embedding_slip", rules.checks.embedding_slip_ratio);
  w.exact("embedding_turns", rules.checks.embedding_turns);
  w.exact("embedding_sinkage_share", rules.checks.embedding_sinkage_share);
  w.end_object();
  w.key("bars").begin_object();
  w.exact("max_embedding", rules.bars.max_embedding);
  w.exact("max_expected_stops", rules.bars.max_expected_stops);
  w.end_object();
}

Result<RuleSet> read_rules_file(std::string_view bytes) {
  const auto document = parse(bytes);
  if (!document) return fail(document.error());
  RuleSet set;
  std::vector<Fault> faults;
  ObjectReader reader(*document, "", faults);
  std::size_t format = 0;
  reader.choice("format", kRequired, {"rules/1"}, format);
  reader.text("name", kRequired, {.most = 64, .is_name = true}, set.name);
  reader.text("summary", kRequired, {.most = 500}, set.summary);
  reader.text("source", kRequired, {.most = 1000}, set.source);
  read_drive_rules(reader, set.rules);
  reader.refuse_unknown();
  if (!faults.empty()) return fail(ErrorCode::kUnreadableData, summary_of(faults), faults);
  return set;
}

}  // namespace slipway::api::json
