#include "api/documents/check_answer.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "api/documents/check_request.h"
#include "api/documents/departure.h"
#include "api/documents/drive_routes.h"
#include "api/documents/drive_series.h"
#include "api/documents/drive_so_far.h"
#include "core/angle.h"
#include "planner/judge/drive_verdict.h"
#include "planner/judge/verdict_words.h"
#include "planner/problem/displaced_start.h"

namespace slipway::api::json {
namespace {

// A limit that nobody has set is left out.
void write_rule(Writer& w, const sim::RuleRisk& rule, const sim::DrivePrediction& prediction) {
  const sim::RuleRow& row = sim::row_of(rule.rule);
  if (!std::isfinite(rule.limit)) return;
  const auto in_unit = [&](const sim::DrawnSpread& spread) -> sim::DrawnSpread {
    return {row.factor * spread.p05, row.factor * spread.p50, row.factor * spread.p95};
  };
  w.begin_object().text("rule", row.name).text("words", row.words).text("unit", row.unit);
  w.significant("limit", row.factor * rule.limit);
  write_spread(w, "value", in_unit(rule.value));
  if (rule.tripping) write_spread(w, "tripping_value", in_unit(*rule.tripping));
  write_share(w, "trips", rule.trips);
  w.significant("halts", rule.halts);
  const bool trips = rule.trips.share > 0.0;
  if (trips) {
    w.metres("from_m", rule.from_m).metres("to_m", rule.to_m);
  } else {
    w.key("from_m").null().key("to_m").null();
  }
  w.key("wheel");
  if (trips && rule.wheel >= 0)
    w.text(prediction.wheel_names[static_cast<std::size_t>(rule.wheel)]);
  else
    w.null();
  w.key("cause");
  if (trips)
    w.text(planner::cause_of(rule, prediction));
  else
    w.null();
  w.end_object();
}

}  // namespace

void write_judged_rule(Writer& w, const planner::JudgedRule& rule) {
  w.begin_object().text("rule", rule.name).text("verdict", planner::describe(rule.verdict));
  w.text("words", rule.words).text("unit", rule.unit);
  w.key("value").begin_object().significant("value", rule.value).significant("low", rule.low);
  w.significant("high", rule.high).end_object();
  w.significant("go_below", rule.go_below).significant("no_go_above", rule.no_go_above);
  if (rule.at_m) w.metres("at_m", *rule.at_m);
  w.end_object();
}

namespace {

void write_advice(Writer& w, const planner::Advice& advice) {
  w.begin_object().text("kind", planner::describe(advice.kind)).text("words", advice.words);
  if (advice.kind == planner::Advice::Kind::kOtherRoute)
    w.whole("route", advice.route);
  else
    w.metres("at_m", advice.to_m).metres("x_m", advice.x_m).metres("y_m", advice.y_m);
  w.end_object();
}

void write_starts(Writer& w, const planner::DisplacedStarts& displaced) {
  const planner::DisplacedStart& worst = displaced.worst();
  w.key("starts").begin_object().metres("position_m", displaced.error.position_m);
  w.angle_deg("heading_deg", displaced.error.heading_rad);
  w.whole("starts", static_cast<std::int64_t>(displaced.starts.size()));
  for (const planner::Verdict each :
       {planner::Verdict::kGo, planner::Verdict::kUnknown, planner::Verdict::kNoGo})
    w.whole(planner::describe(each), static_cast<std::int64_t>(displaced.count(each)));
  w.key("worst").begin_object().metres("ahead_m", worst.ahead_m).metres("left_m", worst.left_m);
  w.angle_deg("turned_deg", worst.turned_rad).text("verdict", planner::describe(worst.verdict));
  w.key("rule");
  if (worst.rule)
    write_judged_rule(w, *worst.rule);
  else
    w.null();
  w.significant("max_slip_ratio", worst.max_slip_ratio);
  if (worst.at) w.metres("x_m", worst.at->x_m).metres("y_m", worst.at->y_m);
  w.end_object().end_object();
}

}  // namespace

void write_decision(Writer& w, const planner::DriveVerdict& decision) {
  w.key("decision").begin_object().text("verdict", planner::describe(decision.verdict));
  w.texts("reasons", decision.reasons).key("rules").begin_array();
  for (const planner::JudgedRule& rule : decision.rules) write_judged_rule(w, rule);
  w.end_array().key("advice").begin_array();
  for (const planner::Advice& advice : decision.advice) write_advice(w, advice);
  w.end_array();
  if (!decision.otherwise.empty()) w.text("otherwise", decision.otherwise);
  if (decision.departures) write_departures(w, *decision.departures);
  if (decision.starts) write_starts(w, *decision.starts);
  w.end_object();
}

namespace {

// The largest part of the way that is lost unseen between two checks: the slip over an interval times its
// length.
sim::DrawnSpread between_checks_m(const sim::DriveOutcomes& outcomes, double every_m) {
  for (const sim::RuleRisk& rule : outcomes.rules)
    if (rule.rule == sim::Rule::kSlipCheck)
      return {every_m * rule.value.p05, every_m * rule.value.p50, every_m * rule.value.p95};
  return {};
}

// Behind the path's end, to the left of it, and of its heading: each grows along the way.
void write_position(Writer& w, const sim::StretchRisk& stretch) {
  const sim::DrawnSpread& turned = stretch.turned_rad;
  write_spread(w, "shortfall_m", stretch.shortfall_m);
  write_spread(w, "cross_track_m", stretch.drift_m);
  write_spread(w, "heading_deg",
               {deg_from_rad(turned.p05), deg_from_rad(turned.p50), deg_from_rad(turned.p95)});
}

}  // namespace

void write_position_uncertainty(Writer& w, const sim::DrivePrediction& prediction,
                                const sim::SlipChecks& checks) {
  const std::vector<sim::StretchRisk>& stretches = prediction.outcomes.stretches;
  const double commanded_m = stretches.empty() ? 0.0 : stretches.back().to_m;
  w.key("position_uncertainty").begin_object().metres("commanded_m", commanded_m);
  write_position(w, stretches.empty() ? sim::StretchRisk{} : stretches.back());
  write_spread(w, "between_checks_m",
               between_checks_m(prediction.outcomes, std::min(checks.slip_check_every_m, commanded_m)));
  w.key("stretches").begin_array();
  for (const sim::StretchRisk& stretch : stretches) {
    w.begin_object().metres("from_m", stretch.from_m).metres("to_m", stretch.to_m);
    write_position(w, stretch);
    w.end_object();
  }
  w.end_array().end_object();
}

namespace {

void write_shares(Writer& w, const sim::OutcomeShares& shares) {
  write_share(w, "stop", shares.stop);
  write_share(w, "immobilised", shares.immobilised);
  write_share(w, "embedding", shares.embedding);
}

void write_scout(Writer& w, const std::optional<sim::ScoutDrive>& scout, const Provenance& provenance) {
  w.key("scout");
  if (!scout) {
    w.null();
    return;
  }
  w.begin_object().key("soil");
  if (scout->soil)
    w.text(provenance.soils[*scout->soil]);
  else
    w.null();
  w.metres("from_m", scout->from_m).metres("to_m", scout->to_m);
  w.metres("x_m", scout->from.x_m).metres("y_m", scout->from.y_m).angle_deg("yaw_deg", scout->from.yaw_rad);
  write_spread(w, "slip", scout->slip_ratio);
  w.significant("expected_stops", scout->expected_stops).significant("embedding", scout->embedding);
  w.key("verdict_afterwards").begin_object().significant("go", scout->go).significant("no_go", scout->no_go);
  w.significant("unknown", std::max(0.0, 1.0 - scout->go - scout->no_go)).end_object();
  w.significant("worth_sols", scout->worth_sols).end_object();
}

// Each with a verdict of its own.
void write_segments(Writer& w, const sim::DriveOutcomes& outcomes, const sim::OutcomeBars& bars) {
  w.key("segments").begin_array();
  for (const sim::SegmentRisk& segment : outcomes.segments) {
    w.begin_object().metres("from_m", segment.from_m).metres("to_m", segment.to_m);
    w.text("verdict", planner::describe(planner::judge_segment(bars, segment)));
    write_shares(w, segment);
    w.significant("reached", segment.reached).end_object();
  }
  w.end_array();
}

}  // namespace

void write_outcomes(Writer& w, const sim::DrivePrediction& prediction, const Provenance& provenance,
                    const sim::OutcomeBars& bars) {
  const sim::DriveOutcomes& outcomes = prediction.outcomes;
  w.key("outcomes").begin_object();
  write_shares(w, outcomes);
  write_share(w, "completed", outcomes.completed);
  w.key("expected_stops").begin_object().significant("value", outcomes.expected_stops);
  w.significant("low", outcomes.expected_stops_low)
      .significant("high", outcomes.expected_stops_high)
      .end_object();
  // A sol for each segment, and one more for each halt until the drive is through.
  const double driven = std::max<double>(1.0, static_cast<double>(outcomes.segments.size()));
  w.significant("expected_sols", driven + outcomes.expected_stops);
  w.whole("draws", prediction.draws).significant("effective_draws", outcomes.effective_draws);
  w.key("rules").begin_array();
  for (const sim::RuleRisk& rule : outcomes.rules) write_rule(w, rule, prediction);
  w.end_array();
  w.key("grounds").begin_array();
  for (const sim::GroundRisk& ground : outcomes.grounds) {
    w.begin_object().key("soil");
    if (ground.soil)
      w.text(provenance.soils[*ground.soil]);
    else
      w.null();
    w.metres("length_m", ground.length_m).significant("expected_stops", ground.expected_stops);
    w.significant("embedding", ground.embedding).end_object();
  }
  w.end_array();
  w.key("stretches").begin_array();
  for (const sim::StretchRisk& stretch : outcomes.stretches) {
    w.begin_object().metres("from_m", stretch.from_m).metres("to_m", stretch.to_m);
    w.significant("expected_stops", stretch.expected_stops).significant("embedding", stretch.embedding);
    w.end_object();
  }
  w.end_array();
  if (!outcomes.segments.empty()) write_segments(w, outcomes, bars);
  write_scout(w, prediction.scout, provenance);
  w.end_object();
}

std::string write_check_answer(const CheckAnswer& answer, StationDetail detail) {
  Writer w;
  w.begin_object().text("format", "check/1");
  w.text("terrain", answer.request.terrain).text("rover", answer.request.rover);
  w.text("verdict", planner::describe(answer.decision.verdict)).texts("reasons", answer.decision.reasons);
  write_decision(w, answer.decision);
  write_provenance(w, answer.provenance);
  write_learnt_drive(w, answer.provenance.learnt, answer.request.drive);
  w.key("request").raw(write_check_request(answer.request));
  write_outcomes(w, answer.prediction, answer.provenance, answer.request.drive.bars);
  write_position_uncertainty(w, answer.prediction, answer.request.drive.checks);
  w.key("summary").begin_object();
  write_drive_figures(w, answer.prediction);
  w.end_object();
  write_route(w, answer.prediction, answer.provenance, detail);
  w.end_object();
  return w.take();
}

}  // namespace slipway::api::json
