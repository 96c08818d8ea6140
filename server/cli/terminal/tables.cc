#include "server/cli/terminal/tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "api/json/lookup.h"
#include "api/json/parse.h"
#include "api/report/check_advice.h"
#include "server/cli/terminal/text_table.h"

namespace slipway::server {
namespace {

using api::json::at;
using api::json::JsonValue;
using api::json::number;
using api::json::text;

std::string duration(double seconds) {
  const long minutes = std::lround(seconds / 60.0);
  return fmt::format("{}:{:02d} h", minutes / 60, minutes % 60);
}

std::string peak(const JsonValue& figures, std::string_view key, const char* format) {
  const JsonValue& p = at(figures, key);
  if (p.is(JsonValue::Kind::kNull)) return "-";
  return fmt::format("{} @{:.0f} m", fmt::format(fmt::runtime(format), number(p, "value")),
                     number(p, "at_m"));
}

// "-" where it is not known: on ground that is known by a slip curve alone.
std::string figure(const JsonValue& figures, std::string_view key, const char* format) {
  if (at(figures, key).is(JsonValue::Kind::kNull)) return "-";
  return fmt::format(fmt::runtime(format), number(figures, key));
}

std::vector<std::string> figures_row(std::string label, const JsonValue& f, std::string verdict) {
  const JsonValue& risk = at(f, "risk");
  return {std::move(label),
          fmt::format("{:.1f} m", number(f, "length_m")),
          duration(number(f, "duration_s")),
          figure(f, "energy_wh", "{:.0f} Wh"),
          fmt::format("{:.3f}", number(f, "mean_slip")),
          peak(f, "max_slip", "{:.2f}"),
          peak(f, "max_tilt_deg", "{:.1f} deg"),
          peak(f, "max_sinkage_m", "{:.3f} m"),
          peak(f, "max_current_a", "{:.2f} A"),
          fmt::format("{:.0f} %", 100.0 * number(risk, "value")),
          fmt::format("{:.0f} m", number(f, "unknown_length_m")),
          std::move(verdict)};
}

std::vector<std::string> figures_header() {
  return {"route",        "length",  "time",    "energy", "mean slip", "largest slip",
          "largest tilt", "sinkage", "current", "risk",   "unknown",   "verdict"};
}

std::string lines(const JsonValue& list, std::string_view before) {
  std::string out;
  for (const JsonValue& line : list.elements) out += fmt::format("{}{}\n", before, line.text);
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
  std::string out = table.print();
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

// What cells of the map's size can't show, where they are large.
std::string unseen_line(const JsonValue& document) {
  const JsonValue* const unseen = at(document, "provenance").find("unseen_relief");
  return unseen == nullptr ? std::string() : fmt::format("Beyond this map: {}\n", unseen->text);
}

// What a scout drive onto the ground that decides the best route would be worth.
std::string scout_lines(const JsonValue& plan) {
  const JsonValue& scout = at(plan, "scout");
  if (!scout.is(JsonValue::Kind::kObject)) return {};
  const JsonValue& best = at(at(plan, "routes"), "features").elements.front();
  return fmt::format(
      "{}. Of route {:.0f}; it would lower the expected cost by {:.2f}, and another route is then "
      "the cheapest with {:.0f} %\n",
      api::scout_words(at(at(best, "properties"), "outcomes")), number(scout, "route"),
      number(scout, "worth"), 100.0 * number(scout, "other_route"));
}

}  // namespace

Result<std::string> plan_table(std::string_view answer) {
  const auto document = read(answer);
  if (!document) return fail(document.error());
  const JsonValue& summary = at(*document, "summary");
  std::string out;
  if (!summary.elements.empty()) {
    TextTable table(figures_header());
    for (const JsonValue& route : summary.elements)
      table.add(figures_row(fmt::format("{:.0f}", number(route, "rank")), route, text(route, "verdict")));
    out = table.print() + "\n";
  }
  for (const JsonValue& route : summary.elements) {
    out += fmt::format("Route {:.0f}: {} (cost {:.2f}, proposed by {}, {})\n", number(route, "rank"),
                       text(route, "verdict"), number(route, "cost"), text(route, "planner"),
                       text(route, "profile"));
    out += lines(at(route, "reasons"), "  - ");
    if (at(route, "pareto").boolean && summary.elements.size() > 1)
      out += "  - no other route is at least as good in duration, energy, expected stops and embedding\n";
  }
  out += unseen_line(*document) + scout_lines(*document) + learnt_lines(*document);
  for (const JsonValue& route : summary.elements) {
    const std::string shown =
        dynamic_lines(route, fmt::format("Route {:.0f} verified by dynamics", number(route, "rank")));
    if (!shown.empty()) out += "\n" + shown;
  }
  out += lines(at(*document, "fewer_because"), "Fewer routes than asked for: ");
  return out;
}

// Two rows a pair of routes, and under them what changed.
Result<std::string> comparison_table(std::string_view comparison) {
  const auto document = read(comparison);
  if (!document) return fail(document.error());
  TextTable table({"route", "energy", "mean slip", "largest slip", "sinkage", "current", "risk", "verdict"});
  std::string changes;
  std::size_t pair = 0;
  for (const JsonValue& routes : at(*document, "routes").elements) {
    ++pair;
    for (const char* const side : {"nominal", "corrected"}) {
      const JsonValue& f = at(routes, side);
      if (!f.is(JsonValue::Kind::kObject)) continue;
      table.add({fmt::format("{} {} (rank {:.0f})", pair, side, number(f, "rank")),
                 figure(f, "energy_wh", "{:.0f} Wh"), fmt::format("{:.3f}", number(f, "mean_slip")),
                 fmt::format("{:.2f}", number(f, "max_slip")), figure(f, "max_sinkage_m", "{:.3f} m"),
                 figure(f, "max_current_a", "{:.2f} A"), fmt::format("{:.0f} %", 100.0 * number(f, "risk")),
                 text(f, "verdict")});
    }
    const JsonValue& changed = at(routes, "changed");
    if (changed.elements.empty()) changes += fmt::format("Route {}: nothing changed to speak of\n", pair);
    changes += lines(changed, fmt::format("Route {}: ", pair));
  }
  return table.print() + "\n" + changes;
}

namespace {

std::string_view verdict_words(std::string_view verdict) {
  if (verdict == "go") return "GO";
  return verdict == "no_go" ? "NO-GO" : "UNKNOWN";
}

std::string share_words(const JsonValue& share) {
  return fmt::format("{:.1f} % ({:.1f} to {:.1f})", 100.0 * number(share, "value"),
                     100.0 * number(share, "low"), 100.0 * number(share, "high"));
}

// One row a rule: what it is worth, how near the drive comes, where and how often it trips.
std::string rules_table(const JsonValue& outcomes) {
  TextTable table({"rule", "limit", "value 5, 50, 95 %", "margin", "trips (90 % interval)", "from", "to",
                   "wheel", "cause"});
  for (const JsonValue& rule : at(outcomes, "rules").elements) {
    const JsonValue& value = at(rule, "value");
    const std::string& unit = text(rule, "unit") == "1" ? std::string() : " " + text(rule, "unit");
    const bool trips = !at(rule, "from_m").is(JsonValue::Kind::kNull);
    table.add({text(rule, "rule"), fmt::format("{:.3g}{}", number(rule, "limit"), unit),
               fmt::format("{:.3g}, {:.3g}, {:.3g}", number(value, "p05"), number(value, "p50"),
                           number(value, "p95")),
               fmt::format("{:.3g}", number(rule, "margin")), share_words(at(rule, "trips")),
               trips ? fmt::format("{:.1f} m", number(rule, "from_m")) : "-",
               trips ? fmt::format("{:.1f} m", number(rule, "to_m")) : "-",
               at(rule, "wheel").is(JsonValue::Kind::kNull) ? "-" : text(rule, "wheel"),
               text(rule, "cause")});
  }
  return table.print();
}

std::string decision_lines(std::string_view verdict, const JsonValue& reasons) {
  std::string out = fmt::format("{}\n", verdict_words(verdict));
  for (const JsonValue& reason : reasons.elements) out += fmt::format("  - {}\n", reason.text);
  return out;
}

}  // namespace

Result<std::string> check_table(std::string_view answer) {
  const auto document = read(answer);
  if (!document) return fail(document.error());
  const JsonValue& outcomes = at(*document, "outcomes");
  const JsonValue& figures = at(*document, "summary");
  std::string out = decision_lines(text(*document, "verdict"), at(*document, "reasons"));
  out += fmt::format("\n{:.1f} m, {}, {:.2f} sols expected, {:.0f} draws of the ground\n\n",
                     number(figures, "length_m"), duration(number(figures, "duration_s")),
                     number(outcomes, "expected_sols"), number(outcomes, "draws"));
  out += rules_table(outcomes);
  out += learnt_lines(*document);
  const JsonValue& uncertainty = at(*document, "position_uncertainty");
  const JsonValue& behind = at(uncertainty, "shortfall_m");
  out += fmt::format(
      "\nCommanded by the way its wheels roll, the rover ends {:.2f} m behind the end of {:.1f} m (90 % "
      "interval {:.2f} to "
      "{:.2f})\n\nWhat would change it:\n",
      number(behind, "p50"), number(uncertainty, "commanded_m"), number(behind, "p05"),
      number(behind, "p95"));
  for (const std::string& advice : api::check_advice(*document)) out += fmt::format("  - {}\n", advice);
  return out + unseen_line(*document);
}

Result<std::string> prediction_table(std::string_view answer) {
  const auto document = read(answer);
  if (!document) return fail(document.error());
  const JsonValue& figures = at(*document, "summary");
  const JsonValue& stuck = at(figures, "immobilised");
  TextTable table(figures_header());
  table.add(figures_row("given", figures, stuck.is(JsonValue::Kind::kNull) ? "arrives" : "immobilised"));
  std::string out = table.print();
  if (!stuck.is(JsonValue::Kind::kNull)) out += fmt::format("\nImmobilised: {}\n", text(stuck, "reason"));
  out += lines(at(figures, "broken_limits"), "Limit broken: ");
  const std::string shown = dynamic_lines(figures, "Verified by dynamics");
  if (!shown.empty()) out += "\n" + shown;
  const JsonValue& decision = at(*document, "decision");
  return out + "\n" + decision_lines(text(decision, "verdict"), at(decision, "reasons")) +
         unseen_line(*document);
}

Result<std::string> wheel_table(std::string_view answer) {
  const auto document = read(answer);
  if (!document) return fail(document.error());
  struct Shown {
    const char *key, *title, *format;
    double scale;
  };
  constexpr Shown kShown[] = {{"slip", "slip", "{:.3f}", 1.0},
                              {"slip_angle_deg", "slip angle deg", "{:.1f}", 1.0},
                              {"load_n", "load N", "{:.1f}", 1.0},
                              {"sinkage_m", "sinkage mm", "{:.1f}", 1e3},
                              {"entry_angle_deg", "entry deg", "{:.1f}", 1.0},
                              {"drawbar_pull_n", "pull N", "{:.1f}", 1.0},
                              {"lateral_force_n", "lateral N", "{:.1f}", 1.0},
                              {"torque_nm", "torque N m", "{:.3f}", 1.0},
                              {"current_a", "current A", "{:.3f}", 1.0},
                              {"thrust_n", "thrust N", "{:.1f}", 1.0},
                              {"compaction_resistance_n", "compaction N", "{:.1f}", 1.0},
                              {"tractive_efficiency", "efficiency", "{:.3f}", 1.0}};
  constexpr Shown kOfRover[] = {
      {"slope_deg", "slope deg", "{:.1f}", 1.0},   {"slip", "slip", "{:.3f}", 1.0},
      {"sinkage_m", "deepest mm", "{:.1f}", 1e3},  {"load_n", "loads N", "{:.1f}", 1.0},
      {"drawbar_pull_n", "pull N", "{:.1f}", 1.0}, {"torque_nm", "torque N m", "{:.3f}", 1.0},
      {"current_a", "current A", "{:.3f}", 1.0},   {"power_w", "power W", "{:.2f}", 1.0},
      {"lean_deg", "lean deg", "{:.2f}", 1.0}};
  const bool whole_rover = at(*document, "request").find("whole_rover") != nullptr;
  const std::span<const Shown> columns =
      whole_rover ? std::span<const Shown>(kOfRover) : std::span<const Shown>(kShown);
  // Swept parameters that are none of the columns stand before them.
  std::vector<std::string> header, extra;
  for (const JsonValue& axis : at(at(*document, "request"), "sweep").elements) {
    const std::string& name = text(axis, "parameter");
    const auto is_this = [&](const Shown& shown) { return name == shown.key; };
    if (std::none_of(columns.begin(), columns.end(), is_this)) extra.push_back(name);
  }
  header = extra;
  for (const Shown& shown : columns) header.emplace_back(shown.title);
  header.emplace_back("outcome");
  TextTable table(header);
  for (const JsonValue& row : at(*document, "rows").elements) {
    std::vector<std::string> cells;
    for (const std::string& name : extra) cells.push_back(fmt::format("{:g}", number(row, name)));
    for (const Shown& shown : columns) {
      const bool there = row.find(shown.key) != nullptr;
      cells.push_back(there ? fmt::format(fmt::runtime(shown.format), shown.scale * number(row, shown.key))
                            : "-");
    }
    const std::string& reason = text(row, "reason");
    cells.push_back(reason.empty() ? text(row, "outcome") : reason);
    table.add(std::move(cells));
  }
  return table.print();
}

std::string error_text(const Error& error) {
  const ErrorRow& row = error_row(error.code);
  constexpr std::size_t kListed = 30;
  std::string out = fmt::format("{}: {}\n", row.name, error.detail);
  const std::size_t listed = std::min(kListed, error.faults.size());
  for (const Fault& fault : std::span(error.faults).first(listed))
    out +=
        fmt::format("  {}: {}\n", fault.pointer.empty() ? "(the whole input)" : fault.pointer, fault.message);
  if (listed < error.faults.size())
    out += fmt::format("  and {} more faults\n", error.faults.size() - listed);
  return out + fmt::format("{}\n", row.help);
}

}  // namespace slipway::server
