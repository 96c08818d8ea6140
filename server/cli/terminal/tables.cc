#include "server/cli/terminal/tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <vector>

#include "api/json/lookup.h"
#include "api/json/parse.h"
#include "server/cli/terminal/text_table.h"

namespace slipway::server {
namespace {

using api::json::at;
using api::json::JsonValue;
using api::json::number;
using api::json::text;

// "-" where it is not known: on ground that is known by a slip curve alone.
std::string figure(const JsonValue& figures, std::string_view key, const char* format) {
  if (at(figures, key).is(JsonValue::Kind::kNull)) return "-";
  return fmt::format(fmt::runtime(format), number(figures, key));
}

std::string lines(const JsonValue& list, std::string_view before) {
  std::string out;
  for (const JsonValue& line : list.elements) out += fmt::format("{}{}\n", before, line.text);
  return out;
}

Result<JsonValue> read(std::string_view document) {
  return api::json::parse(document, {.bytes = document.size(), .values = document.size()});
}

}  // namespace

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
