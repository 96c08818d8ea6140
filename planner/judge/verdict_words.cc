#include "planner/judge/verdict_words.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "core/angle.h"
#include "planner/judge/drive_verdict.h"

namespace slipway::planner {
namespace {

using sim::Rule;

constexpr double kWorthWords = 0.005;  // share of the draws

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

std::string name_of_ground(const PlanProblem& problem, const sim::DrivePrediction& drive,
                           std::optional<std::size_t> soil) {
  const std::vector<std::string> classes = classes_under(problem, drive, soil);
  if (!soil)
    return classes.empty() ? "unmapped ground"
                           : fmt::format("ground of unknown soil (class {})", fmt::join(classes, ", "));
  const std::string& name = problem.beliefs.known[*soil].name;
  return classes.empty() ? name : fmt::format("{} (class {})", name, fmt::join(classes, ", "));
}

std::string wheel_words(const sim::DrivePrediction& drive, int wheel) {
  return wheel < 0 ? std::string()
                   : fmt::format(" of wheel {}", drive.wheel_names[static_cast<std::size_t>(wheel)]);
}

// "from 3.0 to 8.2 m", "at 3.0 m".
std::string way_words(double from_m, double to_m) {
  if (to_m - from_m < 0.1) return fmt::format("at {:.1f} m", from_m);
  return fmt::format("from {:.1f} to {:.1f} m", from_m, to_m);
}

// "slip 0.57, limit 0.4": the median of the draws in which it trips.
std::string tripping_value(const sim::DrivePrediction& drive, const sim::RuleRisk& rule) {
  const sim::RuleRow& row = sim::row_of(rule.rule);
  if (rule.rule == Rule::kImmobilised) return "the ground holds the rover";
  if (rule.rule == Rule::kStance) return "the wheels find no ground to stand on";
  if (rule.rule == Rule::kEmbedding) return "the wheels dig in";
  const double value = rule.tripping ? rule.tripping->p50 : rule.value.p50;
  return fmt::format("{}{} {}, limit {}", row.quantity, wheel_words(drive, rule.wheel),
                     sim::value_words(rule.rule, value, rule.limit),
                     sim::value_words(rule.rule, rule.limit, sim::kNoLimit));
}

std::string closure_end_words(const sim::ClosureEnd& end) {
  const std::string pair = fmt::format("c1 {:.2f} and c2 {:.2f}", end.c1, end.c2);
  if (end.immobilised_at_m)
    return fmt::format("with {} it is immobilised at {:.1f} m", pair, *end.immobilised_at_m);
  return fmt::format("with {} it {} (slip {:.2f})", pair,
                     end.breaks_a_limit ? "breaks a limit" : "keeps all limits", end.max_slip_ratio);
}

std::string_view plain_cause(std::string_view cause) {
  if (cause == "cross_slope") return "a cross slope";
  if (cause == "climb") return "the climb";
  if (cause == "descent") return "the descent";
  if (cause == "rough_ground") return "rough ground";
  return cause == "load" ? "the load on the wheel" : "the soil";
}

}  // namespace

std::string percent(double share, double bar) {
  const double value = 100.0 * share;
  if (value > 0.0 && value < 0.1) return fmt::format("{:.2g} %", value);
  const bool near = bar > 0.0 && share > 0.0 && std::abs(share - bar) < 0.1 * bar;
  const int digits = (near ? 1 : 0) + (value < 10.0 && value > 0.0 ? 1 : 0);
  return fmt::format("{:.{}f} %", value, digits);
}

std::string share_words(std::string_view what, const sim::DrawnShare& share, double go_below,
                        double no_go_above, Verdict verdict) {
  const double bar = verdict == Verdict::kNoGo ? no_go_above : go_below;
  std::string bars = fmt::format(", GO below {}", percent(go_below));
  if (verdict == Verdict::kNoGo) bars = fmt::format(", NO-GO above {}", percent(no_go_above));
  if (verdict == Verdict::kUnknown)
    bars = fmt::format(", which do not decide: GO below {}, NO-GO above {}", percent(go_below),
                       percent(no_go_above));
  return fmt::format("{} in {} of the draws (90 % interval {} to {}){}", what, percent(share.share, bar),
                     percent(share.low, bar), percent(share.high, bar), bars);
}

std::string_view cause_of(const sim::RuleRisk& rule, const sim::DrivePrediction& drive) {
  const sim::RuleRow& row = sim::row_of(rule.rule);
  if (!row.cause.empty()) return row.cause;
  if (drive.stations.empty()) return "soil";
  const sim::StationPrediction& at = drive.stations[std::min(rule.station, drive.stations.size() - 1)];
  const double climb = -at.attitude.pitch_rad * (at.station.backwards ? -1.0 : 1.0);
  const double side = std::abs(at.attitude.roll_rad);
  constexpr double kSteep_rad = rad_from_deg(5.0);
  if (std::max(climb, side) < kSteep_rad && !row.of_shape) return "soil";
  return side > std::abs(climb) ? "cross_slope" : climb > 0.0 ? "climb" : "descent";
}

const sim::StationPrediction* worst_station(const sim::DrivePrediction& drive) {
  const auto worst = std::max_element(
      drive.stations.begin(), drive.stations.end(),
      [](const sim::StationPrediction& a, const sim::StationPrediction& b) { return a.stops < b.stops; });
  return worst == drive.stations.end() || worst->stops <= 0.0 ? nullptr : &*worst;
}

const sim::RuleRisk* main_halt(const sim::DrivePrediction& drive) {
  const auto& rules = drive.outcomes.rules;
  const auto main =
      std::max_element(rules.begin(), rules.end(),
                       [](const sim::RuleRisk& a, const sim::RuleRisk& b) { return a.halts < b.halts; });
  return main == rules.end() || main->halts <= 0.0 ? nullptr : &*main;
}

std::string halt_words(const PlanProblem& problem, const sim::DrivePrediction& drive,
                       const sim::RuleRisk& rule) {
  const bool is_main = &rule == main_halt(drive);
  const sim::StationPrediction* at = is_main ? worst_station(drive) : nullptr;
  if (at == nullptr && rule.station < drive.stations.size()) at = &drive.stations[rule.station];
  const std::string ground =
      at == nullptr
          ? std::string()
          : fmt::format(", most at {:.1f} m, ({:.1f}, {:.1f}), on {}", at->station.distance_m,
                        at->station.pose.x_m, at->station.pose.y_m,
                        name_of_ground(problem, drive, at->on_unknown_ground ? std::nullopt : at->soil));
  return fmt::format("{} {}{}, because of {}", tripping_value(drive, rule), way_words(rule.from_m, rule.to_m),
                     ground, plain_cause(cause_of(rule, drive)));
}

std::vector<std::string> tripping_words(const sim::DrivePrediction& drive) {
  std::vector<sim::RuleRisk> rules = drive.outcomes.rules;
  std::stable_sort(rules.begin(), rules.end(), [](const sim::RuleRisk& a, const sim::RuleRisk& b) {
    return a.trips.share > b.trips.share;
  });
  std::vector<std::string> words;
  for (const sim::RuleRisk& rule : rules)
    if (rule.trips.share >= kWorthWords)
      words.push_back(fmt::format("{} trips in {} of the draws, {}: {}", sim::describe(rule.rule),
                                  percent(rule.trips.share), way_words(rule.from_m, rule.to_m),
                                  tripping_value(drive, rule)));
  return words;
}

std::string nearest_limit_words(const sim::DrivePrediction& drive) {
  const sim::RuleRisk* nearest = nullptr;
  double least = 1.0;
  for (const sim::RuleRisk& rule : drive.outcomes.rules) {
    const sim::RuleRow& row = sim::row_of(rule.rule);
    if (!row.limit || !std::isfinite(rule.limit) || rule.limit <= 0.0) continue;
    const bool from_below = row.trips == sim::Trips::kBelow;
    const double left = from_below ? rule.value.p05 / rule.limit - 1.0 : 1.0 - rule.value.p95 / rule.limit;
    if (left < 0.0 || left >= least) continue;
    least = left;
    nearest = &rule;
  }
  if (nearest == nullptr) return {};
  const bool from_below = sim::row_of(nearest->rule).trips == sim::Trips::kBelow;
  const double value = from_below ? nearest->value.p05 : nearest->value.p95;
  const std::string place =
      nearest->station < drive.stations.size()
          ? fmt::format(" at {:.0f} m", drive.stations[nearest->station].station.distance_m)
          : std::string();
  return fmt::format("nearest to its limit comes the {}: {}{} in all but 5 % of the draws, limit {}",
                     sim::row_of(nearest->rule).quantity,
                     sim::value_words(nearest->rule, value, nearest->limit), place,
                     sim::value_words(nearest->rule, nearest->limit, sim::kNoLimit));
}

std::string ground_words(const PlanProblem& problem, const sim::DrivePrediction& drive) {
  const sim::GroundRisk* worst = nullptr;
  double all = 0.0;
  for (const sim::GroundRisk& ground : drive.outcomes.grounds) {
    all += ground.expected_stops;
    if (!worst || ground.expected_stops > worst->expected_stops) worst = &ground;
  }
  if (all < kWorthWords) return {};
  return fmt::format("{} of the halts happen on the {:.0f} m of {}", percent(worst->expected_stops / all),
                     worst->length_m, name_of_ground(problem, drive, worst->soil));
}

std::string closure_words(const PlanProblem& problem, const sim::DrivePrediction& drive) {
  if (!drive.closures || !drive.closures->decides()) return {};
  const sim::ClosureEnd &least = drive.closures->least, &greatest = drive.closures->greatest;
  return fmt::format(
      "on mean soils the drive hangs on where the stress under the rim of a wheel is greatest (c1 and c2 of "
      "{}): {}, {}; one soil in twenty lies beyond either",
      name_of_ground(problem, drive, (least.fails() ? least : greatest).soil), closure_end_words(least),
      closure_end_words(greatest));
}

std::vector<std::string> segment_words(const sim::DriveOutcomes& outcomes, const sim::OutcomeBars& bars) {
  int go = 0, no_go = 0;
  const sim::SegmentRisk* worst = &outcomes.segments.front();
  const auto badness = [&](const sim::SegmentRisk& s) {
    return std::max({s.stop.share / bars.no_go_stop, s.embedding.share / bars.max_embedding,
                     s.immobilised.share / bars.max_immobilised});
  };
  for (const sim::SegmentRisk& segment : outcomes.segments) {
    if (bars.are_passed(segment)) ++no_go;
    if (bars.are_kept(segment)) ++go;
    if (badness(segment) > badness(*worst)) worst = &segment;
  }
  const auto count = static_cast<int>(outcomes.segments.size());
  return {fmt::format("{} segments, each a sol's drive: {} GO, {} NO-GO, {} UNKNOWN; about {:.0f} sols with "
                      "one more for each halt",
                      count, go, no_go, count - go - no_go, count + outcomes.expected_stops),
          fmt::format("the worst segment is from {:.0f} to {:.0f} m: a halt in {} of the draws that come "
                      "there, immobilised in {}, embedded in {}",
                      worst->from_m, worst->to_m, percent(worst->stop.share),
                      percent(worst->immobilised.share), percent(worst->embedding.share))};
}

}  // namespace slipway::planner
