#include "api/files/drive_rules.h"

#include <fmt/format.h>

#include <cmath>

#include "api/json/faults.h"
#include "api/json/parse.h"

namespace slipway::api::json {
namespace {

void read_limits(ObjectReader& reader, sim::DriveLimits& limits) {
  auto object = reader.object("limits", kOptional);
  if (!object) return;
  for (const sim::RuleRow& row : sim::rule_catalogue()) {
    if (!row.limit) continue;
    double value = 0.0;
    if (object->number(row.key, kOptional, {row.unit, row.least, row.most, !row.least_allowed}, value))
      limits.*row.limit = value / row.factor;
  }
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
  object->number("max_immobilised", kOptional, {"1", 0.0, 1.0, true}, bars.max_immobilised);
  object->number("max_stop", kOptional, {"1", 0.0, 1.0, true}, bars.max_stop);
  object->number("no_go_stop", kOptional, {"1", 0.0, 1.0, true}, bars.no_go_stop);
  if (object->member("max_expected_stops", kOptional) != nullptr)
    object->fault("max_expected_stops",
                  "is no bar any more: max_stop is the probability of a halt below which a drive is a GO, "
                  "no_go_stop the one above which it is a NO-GO");
  if (bars.no_go_stop < bars.max_stop) object->fault("no_go_stop", "no_go_stop must be at least max_stop");
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
  for (const sim::RuleRow& row : sim::rule_catalogue())
    if (row.limit && std::isfinite(rules.limits.*row.limit))
      w.key(row.key).raw(fmt::format("{:.12g}", rules.limits.*row.limit * row.factor));
  w.end_object();
  w.key("checks").begin_object();
  w.exact("slip_check_every_m", rules.checks.slip_check_every_m);
  w.exact("embedding_slip", rules.checks.embedding_slip_ratio);
  w.exact("embedding_turns", rules.checks.embedding_turns);
  w.exact("embedding_sinkage_share", rules.checks.embedding_sinkage_share);
  w.end_object();
  w.key("bars").begin_object();
  w.exact("max_embedding", rules.bars.max_embedding);
  w.exact("max_immobilised", rules.bars.max_immobilised);
  w.exact("max_stop", rules.bars.max_stop);
  w.exact("no_go_stop", rules.bars.no_go_stop);
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
