#include "planner/judge/drive_decision.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "core/angle.h"

namespace slipway::planner {
namespace {

using sim::Rule;

std::string percent(double share) {
  const double value = 100.0 * share;
  return value < 10.0 && value > 0.0 ? fmt::format("{:.1f} %", value) : fmt::format("{:.0f} %", value);
}

std::string embedding_words(const sim::DriveOutcomes& outcomes, double bar, std::string_view side) {
  return fmt::format("embedding in {} of the draws (90 % interval {} to {}), {} the bar of {}",
                     percent(outcomes.embedding.share), percent(outcomes.embedding.low),
                     percent(outcomes.embedding.high), side, percent(bar));
}

std::string stop_words(const sim::DriveOutcomes& outcomes, double bar, std::string_view side) {
  return fmt::format("{:.2f} expected stops (90 % interval {:.2f} to {:.2f}), {} the bar of {:g}",
                     outcomes.expected_stops, outcomes.expected_stops_low, outcomes.expected_stops_high, side,
                     bar);
}

// "above", "below" or "on both sides of".
std::string_view side_of(double low, double high, double bar) {
  if (low > bar) return "above";
  return high < bar ? "below" : "on both sides of";
}

std::string value_words(Rule rule, double value, double limit) {
  switch (rule) {
    case Rule::kTilt:
      return fmt::format("tilt {:.1f} deg, limit {:g}", deg_from_rad(value), deg_from_rad(limit));
    case Rule::kSlipCheck:
      return fmt::format("slip {:.2f} over a check's interval, limit {:g}", value, limit);
    case Rule::kCurrent:
      return fmt::format("current {:.2f} A, limit {:g}", value, limit);
    case Rule::kSinkage:
      return fmt::format("sinkage {:.3f} m, limit {:g}", value, limit);
    case Rule::kClearance:
      return fmt::format("clearance {:.2f} m, limit {:g}", value, limit);
    case Rule::kEmbedding:
      break;
  }
  return "embedding";
}

// The rules that trip, the likeliest first: where, how often and by how much.
void add_rules(const sim::DrivePrediction& drive, std::vector<std::string>& reasons) {
  std::vector<sim::RuleRisk> rules = drive.outcomes.rules;
  std::stable_sort(rules.begin(), rules.end(), [](const sim::RuleRisk& a, const sim::RuleRisk& b) {
    return a.trips.share > b.trips.share;
  });
  for (const sim::RuleRisk& rule : rules) {
    if (rule.trips.share <= 0.0) continue;
    const std::string wheel =
        rule.wheel < 0 ? std::string()
                       : fmt::format(", wheel {}", drive.wheel_names[static_cast<std::size_t>(rule.wheel)]);
    reasons.push_back(fmt::format("{} trips in {} of the draws, from {:.1f} to {:.1f} m{}: {}",
                                  sim::describe(rule.rule), percent(rule.trips.share), rule.from_m, rule.to_m,
                                  wheel, value_words(rule.rule, rule.value_p50, rule.limit)));
  }
}

// The labels of the map's classes under the stations on a ground, in their order; none of ground that no map
// names and of soils that stand on the map under their own name.
std::vector<std::string> classes_under(const PlanProblem& problem, const sim::DrivePrediction& drive,
                                       std::optional<std::size_t> soil) {
  std::vector<std::string> labels;
  if (!problem.soil_map) return labels;
  for (const sim::StationPrediction& station : drive.stations) {
    if ((station.on_unknown_ground ? std::nullopt : station.soil) != soil) continue;
    const auto value = problem.soil_map->class_at(station.station.pose.x_m, station.station.pose.y_m);
    for (const dem::SoilClass& row : problem.soil_map->legend())
      if (value == row.value && row.label != row.soil &&
          std::find(labels.begin(), labels.end(), row.label) == labels.end())
        labels.push_back(row.label);
  }
  return labels;
}

std::string ground_words(const PlanProblem& problem, const sim::DrivePrediction& drive,
                         std::optional<std::size_t> soil) {
  const std::vector<std::string> classes = classes_under(problem, drive, soil);
  const std::string name =
      soil ? fmt::format("ground of soil {}", problem.beliefs.known[*soil].name) : "ground of unknown soil";
  return classes.empty() ? (soil ? name : "unmapped ground")
                         : fmt::format("{} (class {} of the map)", name, fmt::join(classes, ", "));
}

// The ground on which most goes wrong.
void add_ground(const PlanProblem& problem, const sim::DrivePrediction& drive,
                std::vector<std::string>& reasons) {
  const sim::DriveOutcomes& outcomes = drive.outcomes;
  const sim::GroundRisk* worst = nullptr;
  double all = 0.0;
  for (const sim::GroundRisk& ground : outcomes.grounds) {
    all += ground.expected_stops + ground.embedding;
    if (!worst || ground.expected_stops + ground.embedding > worst->expected_stops + worst->embedding)
      worst = &ground;
  }
  if (all <= 0.0) return;
  reasons.push_back(fmt::format("{} decides: {} of what goes wrong happens on its {:.0f} m",
                                ground_words(problem, drive, worst->soil),
                                percent((worst->expected_stops + worst->embedding) / all), worst->length_m));
}

std::string closure_end_words(const sim::ClosureEnd& end) {
  const std::string pair = fmt::format("c1 {:.2f} and c2 {:.2f}", end.c1, end.c2);
  if (end.immobilised_at_m)
    return fmt::format("with {} it is immobilised at {:.1f} m", pair, *end.immobilised_at_m);
  return fmt::format("with {} it {} (slip {:.2f})", pair,
                     end.breaks_a_limit ? "breaks a limit" : "keeps all limits", end.max_slip_ratio);
}

// c1 and c2, where the drive on the mean soils hangs on them.
void add_closures(const PlanProblem& problem, const sim::DrivePrediction& drive,
                  std::vector<std::string>& reasons) {
  if (!drive.closures || !drive.closures->decides()) return;
  const sim::ClosureEnd &least = drive.closures->least, &greatest = drive.closures->greatest;
  reasons.push_back(fmt::format(
      "c1 and c2 of {} decide, which place the greatest stress under the rim: on soils that are the mean in "
      "all else, {}, {}; one soil in twenty lies beyond either",
      ground_words(problem, drive, (least.fails() ? least : greatest).soil), closure_end_words(least),
      closure_end_words(greatest)));
}

// A drive over kilometres: how many of its segments are how, its stops and sols in all, and the worst
// segment.
void add_segments(const sim::DriveOutcomes& outcomes, const sim::OutcomeBars& bars,
                  std::vector<std::string>& reasons) {
  int go = 0, no_go = 0;
  const sim::SegmentRisk* worst = &outcomes.segments.front();
  const auto badness = [&](const sim::SegmentRisk& s) {
    return s.expected_stops / bars.max_expected_stops + s.embedding.share / bars.max_embedding;
  };
  for (const sim::SegmentRisk& segment : outcomes.segments) {
    if (bars.are_passed(segment)) ++no_go;
    if (bars.are_kept(segment)) ++go;
    if (badness(segment) > badness(*worst)) worst = &segment;
  }
  const auto count = static_cast<int>(outcomes.segments.size());
  reasons.push_back(fmt::format("{} segments: {} go, {} no go, {} that the draws do not decide", count, go,
                                no_go, count - go - no_go));
  reasons.push_back(
      fmt::format("{:.1f} expected stops (90 % interval {:.1f} to {:.1f}): {:.0f} sols, {} of driving and "
                  "one for each stop",
                  outcomes.expected_stops, outcomes.expected_stops_low, outcomes.expected_stops_high,
                  count + outcomes.expected_stops, count));
  reasons.push_back(
      fmt::format("the worst segment is from {:.0f} to {:.0f} m: {:.2f} expected stops, bar {:g}, and "
                  "embedding in {} of the "
                  "draws that come there, bar {}",
                  worst->from_m, worst->to_m, worst->expected_stops, bars.max_expected_stops,
                  percent(worst->embedding.share), percent(bars.max_embedding)));
}

}  // namespace

std::string_view describe(Decision decision) {
  switch (decision) {
    case Decision::kGo:
      return "go";
    case Decision::kNoGo:
      return "no_go";
    case Decision::kUnknown:
      break;
  }
  return "unknown";
}

Decision decide(const sim::OutcomeBars& bars, const sim::SegmentRisk& segment) {
  if (bars.are_passed(segment)) return Decision::kNoGo;
  return bars.are_kept(segment) ? Decision::kGo : Decision::kUnknown;
}

DriveDecision decide(const PlanProblem& problem, const sim::DrivePrediction& drive) {
  const sim::DriveOutcomes& outcomes = drive.outcomes;
  const sim::OutcomeBars& bars = problem.risk.bars;
  DriveDecision out;
  const std::string embedding =
      embedding_words(outcomes, bars.max_embedding,
                      side_of(outcomes.embedding.low, outcomes.embedding.high, bars.max_embedding));
  const std::string stops =
      stop_words(outcomes, bars.max_expected_stops,
                 side_of(outcomes.expected_stops_low, outcomes.expected_stops_high, bars.max_expected_stops));
  const bool scrapes = std::any_of(
      outcomes.rules.begin(), outcomes.rules.end(),
      [](const sim::RuleRisk& rule) { return rule.rule == Rule::kClearance && rule.trips.share >= 1.0; });
  const bool over = bars.are_passed(outcomes);
  const bool known_is_under = outcomes.embedding_on_known.high < bars.max_embedding &&
                              outcomes.expected_stops_on_known < bars.max_expected_stops;
  if (drive.without_stance) {
    out.decision = Decision::kNoGo;
    out.reasons.push_back(drive.without_stance->reason);
  } else if (scrapes) {
    out.decision = Decision::kNoGo;
    out.reasons.push_back("the belly comes nearer to the ground than its limit, whatever the soil");
  } else if (over && known_is_under) {
    out.reasons.push_back("what goes wrong hangs on ground that no map names");
  } else if (over) {
    out.decision = Decision::kNoGo;
  } else if (bars.are_kept(outcomes)) {
    out.decision = Decision::kGo;
  } else {
    out.reasons.push_back(fmt::format("{} draws of the ground do not decide", drive.draws));
  }
  if (outcomes.segments.empty()) {
    out.reasons.push_back(embedding);
    out.reasons.push_back(stops);
  } else {
    add_segments(outcomes, bars, out.reasons);
  }
  add_rules(drive, out.reasons);
  add_ground(problem, drive, out.reasons);
  add_closures(problem, drive, out.reasons);
  return out;
}

}  // namespace slipway::planner
