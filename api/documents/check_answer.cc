#include "api/documents/check_answer.h"

#include <algorithm>
#include <cmath>

#include "api/documents/check_request.h"
#include "api/documents/drive_routes.h"
#include "api/documents/drive_series.h"
#include "api/documents/drive_so_far.h"
#include "core/angle.h"
#include "planner/judge/drive_decision.h"

namespace slipway::api::json {
namespace {

struct RuleUnit {
  std::string_view unit;
  double factor = 1.0;  // from SI
};

RuleUnit unit_of(sim::Rule rule) {
  switch (rule) {
    case sim::Rule::kTilt:
      return {"deg", deg_from_rad(1.0)};
    case sim::Rule::kCurrent:
      return {"A"};
    case sim::Rule::kSinkage:
    case sim::Rule::kClearance:
      return {"m"};
    case sim::Rule::kSlipCheck:
    case sim::Rule::kEmbedding:
      break;
  }
  return {"1"};
}

// What makes the value what it is, where it comes nearest to its limit.
std::string_view cause_of(const sim::RuleRisk& rule, const sim::DrivePrediction& prediction) {
  if (rule.station >= prediction.stations.size()) return "soil";
  const sim::StationPrediction& at = prediction.stations[rule.station];
  const double climb = -at.attitude.pitch_rad * (at.station.backwards ? -1.0 : 1.0);
  const double side = std::abs(at.attitude.roll_rad);
  if (rule.rule == sim::Rule::kClearance) return "rough_ground";
  constexpr double kSteep_rad = rad_from_deg(5.0);
  if (rule.rule == sim::Rule::kSinkage) return "load";
  if (std::max(climb, side) < kSteep_rad && rule.rule != sim::Rule::kTilt) return "soil";
  return side > climb ? "cross_slope" : climb > 0.0 ? "climb" : "descent";
}

void write_rule(Writer& w, const sim::RuleRisk& rule, const sim::DrivePrediction& prediction) {
  const RuleUnit unit = unit_of(rule.rule);
  const double to_limit =
      rule.rule == sim::Rule::kClearance ? rule.value_p05 - rule.limit : rule.limit - rule.value_p95;
  w.begin_object().text("rule", sim::describe(rule.rule)).text("unit", unit.unit);
  w.significant("limit", unit.factor * rule.limit);
  write_spread(w, "value",
               {unit.factor * rule.value_p05, unit.factor * rule.value_p50, unit.factor * rule.value_p95});
  w.significant("margin", unit.factor * to_limit);
  write_share(w, "trips", rule.trips);
  if (rule.trips.share > 0.0) {
    w.metres("from_m", rule.from_m).metres("to_m", rule.to_m);
  } else {
    w.key("from_m").null().key("to_m").null();
  }
  w.key("wheel");
  if (rule.wheel >= 0)
    w.text(prediction.wheel_names[static_cast<std::size_t>(rule.wheel)]);
  else
    w.null();
  w.text("cause", cause_of(rule, prediction)).end_object();
}

// A check of the slip belongs before each stretch on which something goes wrong in more than this share of
// draws.
constexpr double kWorthACheck = 0.01;

void write_slip_checks(Writer& w, const sim::DriveOutcomes& outcomes) {
  w.key("slip_checks_before_m").begin_array();
  for (const sim::StretchRisk& stretch : outcomes.stretches)
    if (stretch.expected_stops + stretch.embedding > kWorthACheck) w.metres(stretch.from_m);
  w.end_array();
}

// Limits that the predicted drive keeps with a margin: what to command where nothing else is known.
void write_recommended(Writer& w, const sim::DriveOutcomes& outcomes) {
  constexpr double kTiltMargin_deg = 2.0;
  w.key("recommended").begin_object();
  for (const sim::RuleRisk& rule : outcomes.rules)
    if (rule.rule == sim::Rule::kTilt)
      w.significant("max_tilt_deg", deg_from_rad(rule.value_p95) + kTiltMargin_deg);
  write_slip_checks(w, outcomes);
  w.end_object();
}

}  // namespace

void write_decision(Writer& w, const planner::DriveDecision& decision) {
  w.key("decision").begin_object().text("verdict", planner::describe(decision.decision));
  w.texts("reasons", decision.reasons).end_object();
}

namespace {

// The largest part of the way that is lost unseen between two checks: the slip over an interval times its
// length.
sim::DrawnSpread between_checks_m(const sim::DriveOutcomes& outcomes, double every_m) {
  for (const sim::RuleRisk& rule : outcomes.rules)
    if (rule.rule == sim::Rule::kSlipCheck)
      return {every_m * rule.value_p05, every_m * rule.value_p50, every_m * rule.value_p95};
  return {};
}

}  // namespace

void write_position_uncertainty(Writer& w, const sim::DrivePrediction& prediction,
                                const sim::SlipChecks& checks) {
  const std::vector<sim::StretchRisk>& stretches = prediction.outcomes.stretches;
  const double commanded_m = stretches.empty() ? 0.0 : stretches.back().to_m;
  w.key("position_uncertainty").begin_object().metres("commanded_m", commanded_m);
  write_spread(w, "shortfall_m", stretches.empty() ? sim::DrawnSpread{} : stretches.back().shortfall_m);
  write_spread(w, "between_checks_m",
               between_checks_m(prediction.outcomes, std::min(checks.slip_check_every_m, commanded_m)));
  w.key("stretches").begin_array();
  for (const sim::StretchRisk& stretch : stretches) {
    w.begin_object().metres("from_m", stretch.from_m).metres("to_m", stretch.to_m);
    write_spread(w, "shortfall_m", stretch.shortfall_m);
    w.end_object();
  }
  w.end_array().end_object();
}

namespace {

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

}  // namespace

namespace {

// Each with a verdict of its own.
void write_segments(Writer& w, const sim::DriveOutcomes& outcomes, const sim::OutcomeBars& bars) {
  w.key("segments").begin_array();
  for (const sim::SegmentRisk& segment : outcomes.segments) {
    w.begin_object().metres("from_m", segment.from_m).metres("to_m", segment.to_m);
    w.text("verdict", planner::describe(planner::decide(bars, segment)));
    w.key("expected_stops").begin_object().significant("value", segment.expected_stops);
    w.significant("low", segment.expected_stops_low);
    if (std::isfinite(segment.expected_stops_high)) w.significant("high", segment.expected_stops_high);
    w.end_object();
    write_share(w, "stop", segment.stop);
    write_share(w, "embedding", segment.embedding);
    w.significant("reached", segment.reached).end_object();
  }
  w.end_array();
}

}  // namespace

void write_outcomes(Writer& w, const sim::DrivePrediction& prediction, const Provenance& provenance,
                    const sim::OutcomeBars& bars) {
  const sim::DriveOutcomes& outcomes = prediction.outcomes;
  w.key("outcomes").begin_object();
  write_share(w, "stop", outcomes.stop);
  write_share(w, "embedding", outcomes.embedding);
  write_share(w, "completed", outcomes.completed);
  w.key("expected_stops").begin_object().significant("value", outcomes.expected_stops);
  w.significant("low", outcomes.expected_stops_low)
      .significant("high", outcomes.expected_stops_high)
      .end_object();
  // A sol for each segment, and one more for each stop.
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
  write_recommended(w, outcomes);
  write_scout(w, prediction.scout, provenance);
  w.end_object();
}

std::string write_check_answer(const CheckAnswer& answer, StationDetail detail) {
  Writer w;
  w.begin_object().text("format", "check/1");
  w.text("terrain", answer.request.terrain).text("rover", answer.request.rover);
  w.text("verdict", planner::describe(answer.decision.decision)).texts("reasons", answer.decision.reasons);
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
