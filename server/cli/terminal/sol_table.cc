// A sol for people: its plan, where to check the slip, its commands, and the way back out of the worst place.
#include <fmt/format.h>

#include <utility>

#include "api/json/lookup.h"
#include "api/json/parse.h"
#include "api/json/writer.h"
#include "api/report/command_rows.h"
#include "api/report/day_words.h"
#include "core/utc.h"
#include "planner/problem/verdict.h"
#include "server/cli/terminal/tables.h"
#include "server/cli/terminal/text_table.h"

namespace slipway::server {

using api::json::at;
using api::json::has;
using api::json::JsonValue;
using api::json::number;
using api::json::text;

namespace {

// " from 2016-03-22 09:41 UTC on with 57 %", of a check with a departure.
std::string begun(const JsonValue& check) {
  const JsonValue& departure = at(at(check, "request"), "departure");
  if (departure.is(JsonValue::Kind::kNull)) return {};
  return fmt::format(" from {} on with {:.0f} % in the battery", utc_words(api::time_of(departure, "from")),
                     number(departure, "charge_percent"));
}

// One row a command, under the pose from which they are driven.
std::string command_lines(const JsonValue& start, const JsonValue& commands, const JsonValue& checks) {
  TextTable table({"command", "from", "to", "slip"});
  for (const api::CommandRow& row : api::command_rows(commands, checks))
    table.add(
        {row.words, fmt::format("{:.2f} m", row.from_m), fmt::format("{:.2f} m", row.to_m), row.checks});
  return fmt::format("\n{}\n{}\n\n{}", api::start_words(start), api::kCommandSigns, table.print());
}

std::string check_lines(const JsonValue& sol) {
  std::string out = api::assumed_checks_words(at(at(sol, "plan"), "request")) + "\n";
  for (const JsonValue& check : at(sol, "checks").elements)
    out += fmt::format("Check the slip {}, at ({:.1f}, {:.1f}): {}\n",
                       api::check_place_words(number(check, "at_m")), number(check, "x_m"),
                       number(check, "y_m"), text(check, "why"));
  return out;
}

std::string way_back_lines(const JsonValue& back) {
  std::string out = fmt::format(
      "Backing out of it to the start{}: {}{}\n", begun(back), planner::verdict_words(text(back, "verdict")),
      at(back, "reasons").elements.empty() ? "" : ", " + at(back, "reasons").elements.front().text);
  const JsonValue& request = at(back, "request");
  if (!has(request, "commands")) return out;
  return out +
         fmt::format("\nThe commands of the way back{}:",
                     at(request, "backwards").boolean ? ", driven backwards" : "") +
         command_lines(at(request, "start"), at(request, "commands"), {});
}

}  // namespace

Result<std::string> sol_table(std::string_view answer, bool why) {
  const auto document = api::json::parse(answer, {.bytes = answer.size(), .values = answer.size()});
  if (!document) return fail(document.error());
  api::json::Writer plan;
  api::json::write_value(plan, at(*document, "plan"));
  auto out = plan_table(plan.take(), why);
  const auto& summary = at(at(*document, "plan"), "summary").elements;
  if (!out || summary.empty()) return out;
  *out += check_lines(*document);
  const auto place_line = [](const char* what, const JsonValue& place) {
    return fmt::format("{} {:.1f} m, at ({:.1f}, {:.1f}): {}\n", what, number(place, "at_m"),
                       number(place, "x_m"), number(place, "y_m"), text(place, "why"));
  };
  for (const auto& [key, what] :
       {std::pair{"time_runs_out", "Time runs out at"}, {"worst", "The worst place is at"}})
    if (has(*document, key)) *out += place_line(what, at(*document, key));
  const JsonValue& route = summary.front();
  if (has(route, "commands"))
    *out += command_lines(at(route, "start"), at(route, "commands"), at(*document, "checks"));
  if (has(*document, "back_out")) *out += "\n" + way_back_lines(at(*document, "back_out"));
  if (has(*document, "no_way_back"))
    *out += fmt::format("\nNo way back was checked: {}\n", text(*document, "no_way_back"));
  return out;
}

}  // namespace slipway::server
