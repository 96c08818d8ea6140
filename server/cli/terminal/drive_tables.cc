// Plans, predictions and checks as a few lines for people: the verdict with the reason that decides, what
// would make it better, the routes. The rest is printed where it is asked for.
#include <fmt/format.h>

#include <cmath>
#include <vector>

#include "api/json/lookup.h"
#include "api/json/parse.h"
#include "api/report/day_words.h"
#include "api/report/verdict_sections.h"
#include "core/number_words.h"
#include "core/utc.h"
#include "planner/problem/verdict.h"
#include "server/cli/terminal/tables.h"
#include "server/cli/terminal/text_table.h"

namespace slipway::server {
namespace {

using api::json::at;
using api::json::JsonValue;
using api::json::number;
using api::json::text;

bool is_null(const JsonValue& value) {
  return value.is(JsonValue::Kind::kNull);
}

std::string duration(double seconds) {
  const long minutes = std::lround(seconds / 60.0);
  return fmt::format("{}:{:02d} h", minutes / 60, minutes % 60);
}

std::string peak(const JsonValue& figures, std::string_view key, const char* format) {
  const JsonValue& p = at(figures, key);
  if (is_null(p)) return "-";
  return fmt::format("{} @{:.0f} m", fmt::format(fmt::runtime(format), number(p, "value")),
                     number(p, "at_m"));
}

// "-" where it is not known: on ground that is known by a slip curve alone.
std::string figure(const JsonValue& figures, std::string_view key, const char* format) {
  if (is_null(at(figures, key))) return "-";
  return fmt::format(fmt::runtime(format), number(figures, key));
}

// Where most draws halt, and by which rule.
std::string worst_place(const JsonValue& figures) {
  const JsonValue& worst = at(figures, "worst_halt");
  if (is_null(worst)) return "-";
  return fmt::format("{} @{:.0f} m", text(worst, "rule"), number(worst, "at_m"));
}

std::vector<std::string> figures_row(std::string label, const JsonValue& f, std::string_view verdict) {
  return {std::move(label),
          fmt::format("{:.1f} m", number(f, "length_m")),
          duration(number(f, "duration_s")),
          figure(f, "energy_wh", "{:.0f} Wh"),
          fmt::format("{:.1f} %", 100.0 * number(at(f, "stop"), "value")),
          worst_place(f),
          std::string(planner::verdict_words(verdict))};
}

TextTable figures_table(const std::string& label) {
  return TextTable({label, "length", "time", "energy", "P(stop)", "worst place", "verdict"});
}

// What else is known of each drive, where it is asked for.
std::string more_figures(const std::vector<std::pair<std::string, const JsonValue*>>& drives) {
  TextTable table(
      {"route", "cost", "mean slip", "largest slip", "largest tilt", "sinkage", "current", "unknown ground"});
  for (const auto& [label, figures] : drives) {
    const JsonValue& f = *figures;
    table.add({label, f.find("cost") != nullptr ? fmt::format("{:.2f}", number(f, "cost")) : "-",
               fmt::format("{:.3f}", number(f, "mean_slip")), peak(f, "max_slip", "{:.2f}"),
               peak(f, "max_tilt_deg", "{:.1f} deg"), peak(f, "max_sinkage_m", "{:.3f} m"),
               peak(f, "max_current_a", "{:.2f} A"), fmt::format("{:.0f} m", number(f, "unknown_length_m"))});
  }
  return "\n" + table.print();
}

std::string lines(const JsonValue& list, std::string_view before, std::size_t from = 0) {
  std::string out;
  for (std::size_t k = from; k < list.elements.size(); ++k)
    out += fmt::format("{}{}\n", before, list.elements[k].text);
  return out;
}

// The figures of the dynamic level beside the quasi-static ones, and how the drive went.
std::string dynamic_lines(const JsonValue& figures, const std::string& label) {
  const JsonValue& dynamic = at(figures, "dynamic");
  if (!dynamic.is(JsonValue::Kind::kObject)) return {};
  TextTable table({label, "driven", "time", "energy", "largest slip", "largest tilt", "sinkage", "current"});
  const auto add = [&](const char* level, const JsonValue& f, const char* driven) {
    table.add({level, fmt::format("{:.1f} m", number(f, driven)), duration(number(f, "duration_s")),
               figure(f, "energy_wh", "{:.0f} Wh"), peak(f, "max_slip", "{:.2f}"),
               peak(f, "max_tilt_deg", "{:.1f} deg"), peak(f, "max_sinkage_m", "{:.3f} m"),
               peak(f, "max_current_a", "{:.2f} A")});
  };
  add("balance", figures, "length_m");
  add("dynamic", dynamic, "at_m");
  std::string out = "\n" + table.print();
  const std::string& reason = text(dynamic, "reason");
  out += fmt::format("{}: {}{}{}\n", label, text(dynamic, "end"), reason.empty() ? "" : ", ", reason);
  const JsonValue& off = at(dynamic, "max_distance_from_route_m");
  out += fmt::format("Furthest from the route: {:.2f} m at {:.1f} m\n", number(off, "value"),
                     number(off, "at_m"));
  out += lines(at(dynamic, "broken_limits"), "Limit broken at the dynamic level: ");
  const JsonValue& less = at(dynamic, "less_quasi_static");
  out += fmt::format(
      "Dynamic less balance over {:.0f} m, mean: slip {:+.3f}, sinkage {:+.1f} mm, current {:+.2f} A\n",
      number(less, "compared_m"), number(at(less, "slip"), "mean"),
      1e3 * number(at(less, "sinkage_m"), "mean"), number(at(less, "current_a"), "mean"));
  return out;
}

Result<JsonValue> read(std::string_view document) {
  return api::json::parse(document, {.bytes = document.size(), .values = document.size()});
}

// Of a drive under way: each stretch's slip against what was predicted of it.
std::string learnt_lines(const JsonValue& document) {
  const JsonValue& learnt = at(document, "drive_so_far");
  if (!learnt.is(JsonValue::Kind::kObject)) return {};
  TextTable table({"driven so far", "at", "slip", "predicted before 5, 50, 95 %"});
  for (const JsonValue& stretch : at(learnt, "stretches").elements) {
    const JsonValue& predicted = at(stretch, "predicted_slip");
    table.add({fmt::format("{:.1f} - {:.1f} m", number(stretch, "from_m"), number(stretch, "to_m")),
               fmt::format("{:.1f}, {:.1f}", number(stretch, "x_m"), number(stretch, "y_m")),
               fmt::format("{:.2f}", number(stretch, "slip")),
               fmt::format("{:.2f}, {:.2f}, {:.2f}", number(predicted, "p05"), number(predicted, "p50"),
                           number(predicted, "p95"))});
  }
  return "\n" + table.print() +
         fmt::format("{:.0f} of {:.0f} draws of the ground are left in effect\n",
                     number(learnt, "effective_draws"), number(learnt, "draws"));
}

// Slip that rovers measured near the way.
std::string measured_line(const JsonValue& document) {
  const JsonValue* const near = at(document, "provenance").find("measured_near");
  return near == nullptr
             ? std::string()
             : fmt::format(
                   "Measured within {:g} m of the way: {:.0f} steps over {:.0f} m, median slip {:.2f}, "
                   "largest {:.2f}\n",
                   number(*near, "within_m"), number(*near, "steps"), number(*near, "way_m"),
                   number(*near, "median_slip"), number(*near, "largest_slip"));
}

// What cells of the map's size can't show, where they are large.
std::string unseen_line(const JsonValue& document) {
  const JsonValue* const unseen = at(document, "provenance").find("unseen_relief");
  return unseen == nullptr ? std::string() : fmt::format("Beyond this map: {}\n", unseen->text);
}

std::string share_words(const JsonValue& share) {
  return fmt::format("{:.1f} % ({:.1f} to {:.1f})", 100.0 * number(share, "value"),
                     100.0 * number(share, "low"), 100.0 * number(share, "high"));
}

// One row a rule: how near the drive comes to its limit, where and how often it trips, and by how much then.
std::string rules_table(const JsonValue& outcomes) {
  TextTable table({"rule", "limit", "value 5, 50, 95 %", "trips (90 % interval)", "value then", "from", "to",
                   "wheel", "cause"});
  for (const JsonValue& rule : at(outcomes, "rules").elements) {
    const JsonValue& value = at(rule, "value");
    const std::string& unit = text(rule, "unit") == "1" ? std::string() : " " + text(rule, "unit");
    const bool trips = !is_null(at(rule, "from_m"));
    table.add({text(rule, "rule"), plain_number(number(rule, "limit")) + unit,
               fmt::format("{}, {}, {}", plain_number(number(value, "p05")),
                           plain_number(number(value, "p50")), plain_number(number(value, "p95"))),
               share_words(at(rule, "trips")),
               trips ? plain_number(number(at(rule, "tripping_value"), "p50")) : "-",
               trips ? fmt::format("{:.1f} m", number(rule, "from_m")) : "-",
               trips ? fmt::format("{:.1f} m", number(rule, "to_m")) : "-",
               is_null(at(rule, "wheel")) ? "-" : text(rule, "wheel"),
               is_null(at(rule, "cause")) ? "-" : text(rule, "cause")});
  }
  return "\n" + table.print();
}

// "GO: every limit holds ..."
std::string verdict_line(const JsonValue& decision) {
  const JsonValue& reasons = at(decision, "reasons");
  return fmt::format("{}{}\n", planner::verdict_words(text(decision, "verdict")),
                     reasons.elements.empty() ? "" : ": " + reasons.elements.front().text);
}

std::string advice_lines(const JsonValue& decision) {
  if (text(decision, "verdict") == "go") return {};
  std::string out;
  for (const std::string& words : api::what_would_change(decision))
    out += fmt::format("What would change it: {}\n", words);
  return out;
}

// The windows and the best departure of a decision that has them.
std::string departure_lines(const JsonValue& decision) {
  const JsonValue* const departures = decision.find("departures");
  if (departures == nullptr) return {};
  std::string out;
  for (const JsonValue& window : at(*departures, "windows").elements) {
    const planner::DepartureWindow told = api::told_window(window);
    out += told.from_ms == told.to_ms
               ? fmt::format("Depart at {}\n", utc_words(told.from_ms))
               : fmt::format("Depart between {} and {}\n", utc_words(told.from_ms), utc_words(told.to_ms));
  }
  const JsonValue& best = at(*departures, "best");
  const bool holds = !is_null(best);
  const JsonValue& drive = holds ? best : at(*departures, "nearest");
  if (out.empty() && !holds) out += "No departure keeps what is asked of the day\n";
  const auto arrival = [&](std::string_view key) {
    return utc_words(minute_after(api::time_of(drive, key)));
  };
  out += fmt::format(
      "{}: depart {}, arrive {} (at the slow pace, which 95 % of the draws keep, {}), sunlit {:.0f} % of the "
      "time, {}\n",
      holds ? "Best" : "Fewest rules broken", utc_words(api::time_of(drive, "departs")), arrival("arrives"),
      arrival("arrives_late"), 100.0 * number(drive, "lit_share"), api::battery_words(drive, 0));
  if (const auto in_time = api::in_time_words(drive)) out += fmt::format("In time: {}\n", *in_time);
  return out;
}

// What the drive is from other starts, where a decision says it and its first reason does not.
std::string start_line(const JsonValue& decision) {
  for (const JsonValue& rule : at(decision, "rules").elements)
    if (text(rule, "rule") == "start" && text(rule, "words") != at(decision, "reasons").elements.front().text)
      return fmt::format("The start: {}\n", text(rule, "words"));
  return {};
}

// Each rule of the day with its verdict, at the best departure or the nearest.
std::string day_lines(const JsonValue& decision) {
  const JsonValue* const departures = decision.find("departures");
  if (departures == nullptr) return {};
  const JsonValue& best = at(*departures, "best");
  std::string out;
  for (const JsonValue& rule : at(is_null(best) ? at(*departures, "nearest") : best, "rules").elements)
    out += fmt::format("Rule of the day: {}: {}\n", text(rule, "words"),
                       planner::verdict_words(text(rule, "verdict")));
  return out + fmt::format("{}\n", api::kPaceWords);
}

// Behind the end of the path, beside it, and off its heading.
std::string position_line(const JsonValue& document) {
  const JsonValue& uncertainty = at(document, "position_uncertainty");
  const auto spread = [&](std::string_view key, const char* unit) {
    const JsonValue& of = at(uncertainty, key);
    return fmt::format("{:.2f} {} ({:.2f} to {:.2f})", number(of, "p50"), unit, number(of, "p05"),
                       number(of, "p95"));
  };
  return fmt::format(
      "\nWithout a look at where it is, the rover ends {} behind the end of {:.1f} m, {} to the left of it "
      "and "
      "{} off its heading\n",
      spread("shortfall_m", "m"), number(uncertainty, "commanded_m"), spread("cross_track_m", "m"),
      spread("heading_deg", "deg"));
}

const JsonValue& properties_of(const JsonValue& plan, std::size_t route) {
  return at(at(at(plan, "routes"), "features").elements[route], "properties");
}

std::string drive_lines(const JsonValue& document, bool why) {
  const JsonValue &figures = at(document, "summary"), &decision = at(document, "decision");
  TextTable table = figures_table("drive");
  table.add(figures_row("given", figures, text(decision, "verdict")));
  std::string out =
      verdict_line(decision) + advice_lines(decision) + "\n" + table.print() + departure_lines(decision);
  if (!why) return out + measured_line(document) + unseen_line(document) + "Say more: --why\n";
  const JsonValue& outcomes = at(document, "outcomes");
  out += "\n" + lines(at(decision, "reasons"), "  - ", 1);
  out += more_figures({{"given", &figures}}) + rules_table(outcomes) + day_lines(decision) +
         learnt_lines(document);
  out += position_line(document);
  out += fmt::format("{:.0f} sols expected until the drive is through, over {:.0f} draws of the ground\n",
                     std::ceil(number(outcomes, "expected_sols") - 1e-9), number(outcomes, "draws"));
  return out + dynamic_lines(figures, "Verified by dynamics") + measured_line(document) +
         unseen_line(document);
}

std::string why_routes(const JsonValue& plan) {
  const auto& summary = at(plan, "summary").elements;
  std::vector<std::pair<std::string, const JsonValue*>> drives;
  std::string out;
  for (std::size_t k = 0; k < summary.size(); ++k) {
    const JsonValue& route = summary[k];
    const std::string label = fmt::format("{:.0f}", number(route, "rank"));
    drives.emplace_back(label, &route);
    out += fmt::format("\nRoute {} (proposed by {}, {})\n", label, text(route, "planner"),
                       text(route, "profile"));
    out += lines(at(route, "reasons"), "  - ", k == 0 ? 1 : 0);
    out += lines(at(at(properties_of(plan, k), "decision"), "reasons"), "  - ", 1);
    if (at(route, "pareto").boolean && summary.size() > 1)
      out += "  - no other route is at least as good in duration, energy, P(stop) and embedding\n";
    out += dynamic_lines(route, "Route " + label + " verified by dynamics");
  }
  return more_figures(drives) + out + rules_table(at(properties_of(plan, 0), "outcomes"));
}

}  // namespace

Result<std::string> plan_table(std::string_view answer, bool why) {
  const auto document = read(answer);
  if (!document) return fail(document.error());
  const auto& summary = at(*document, "summary").elements;
  std::string out = summary.empty() ? "NO-GO: there is no route\n" : "";
  if (!summary.empty()) {
    const JsonValue& decision = at(properties_of(*document, 0), "decision");
    TextTable table = figures_table("route");
    for (const JsonValue& route : summary)
      table.add(figures_row(fmt::format("{:.0f}", number(route, "rank")), route, text(route, "verdict")));
    out = verdict_line(decision) + advice_lines(decision) + "\n" + table.print() + departure_lines(decision) +
          start_line(decision);
  }
  constexpr std::size_t kFew = 3;
  const JsonValue& fewer = at(*document, "fewer_because");
  for (std::size_t k = 0; k < fewer.elements.size() && (why || k < kFew); ++k)
    out += fmt::format("Fewer routes than asked for: {}\n", fewer.elements[k].text);
  out += measured_line(*document) + unseen_line(*document);
  if (summary.empty()) return out;
  return why ? out + why_routes(*document) + learnt_lines(*document) : out + "Say more: --why\n";
}

Result<std::string> check_table(std::string_view answer, bool why) {
  const auto document = read(answer);
  if (!document) return fail(document.error());
  return drive_lines(*document, why);
}

Result<std::string> prediction_table(std::string_view answer, bool why) {
  return check_table(answer, why);
}

}  // namespace slipway::server
