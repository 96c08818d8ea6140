#include "api/report/sol_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "api/chart/report_page.h"
#include "api/json/lookup.h"
#include "api/json/parse.h"
#include "api/json/writer.h"
#include "api/report/command_rows.h"
#include "api/report/day_words.h"
#include "api/report/route_map.h"
#include "api/report/verdict_sections.h"
#include "core/angle.h"
#include "core/utc.h"
#include "planner/problem/verdict.h"
#include "sky/mars_time.h"

namespace slipway::api {
namespace {

using json::at;
using json::has;
using json::JsonValue;
using json::number;
using json::text;

std::string place_words(const JsonValue& place) {
  return fmt::format("{:.1f} m, at ({:.1f}, {:.1f})", number(place, "at_m"), number(place, "x_m"),
                     number(place, "y_m"));
}

// With a capital and a full stop.
std::string sentence(std::string words) {
  if (!words.empty() && words.front() >= 'a' && words.front() <= 'z')
    words.front() = static_cast<char>(words.front() - 'a' + 'A');
  return words + ".";
}

std::vector<double> of_each(const JsonValue& rows, std::string_view key) {
  std::vector<double> values;
  for (const JsonValue& row : rows.elements) values.push_back(number(row, key));
  return values;
}

// A battery is not below empty.
std::vector<double> charges(const JsonValue& rows, std::string_view key) {
  std::vector<double> percents = of_each(rows, key);
  for (double& percent : percents) percent = std::max(0.0, percent);
  return percents;
}

// Hours from the first departure that was tried.
std::vector<double> departure_hours(const JsonValue& tried) {
  std::vector<double> hours;
  std::optional<std::int64_t> first;
  for (const JsonValue& drive : tried.elements) {
    const std::int64_t at_ms = utc_of_text(text(drive, "departs")).value_or(0);
    if (!first) first = at_ms;
    hours.push_back(static_cast<double>(at_ms - *first) / 3.6e6);
  }
  return hours;
}

// Battery and power along the way, and what each departure leaves in the battery.
std::string day_charts(const JsonValue& departures, const JsonValue& drive) {
  const JsonValue &stations = at(drive, "stations"), &tried = at(departures, "tried");
  const auto line = [](std::string name, std::vector<double> x, std::vector<double> y, std::size_t colour) {
    return ChartSeries{.name = std::move(name), .x = std::move(x), .y = std::move(y), .colour = colour};
  };
  const std::vector<double> way = of_each(stations, "distance_m");
  std::vector<Chart> charts(3);
  charts[0].title = "Battery on the way";
  charts[0].x.title = charts[1].x.title = "way, m";
  charts[0].y.title = "charge, %";
  charts[0].series = {line("median pace", way, charges(stations, "charge_percent"), 0),
                      line("worse pace", way, charges(stations, "charge_low_percent"), 1)};
  charts[1].title = "Power";
  charts[1].y.title = "power, W";
  charts[1].series = {line("gained", way, of_each(stations, "in_w"), 2),
                      line("used", way, of_each(stations, "out_w"), 6)};
  charts[2].title = "By departure";
  charts[2].x.title = "departure, h after the first";
  charts[2].y.title = "least charge, %";
  charts[2].series = {
      line("median pace", departure_hours(tried), charges(tried, "least_charge_percent"), 0),
      line("worse pace", departure_hours(tried), charges(tried, "least_charge_low_percent"), 1)};
  if (!stations.elements.empty() && has(stations.elements.front(), "motor_c")) {
    Chart& motor = charts.emplace_back();
    motor.title = "Hottest drive motor, an envelope";
    motor.x.title = "way, m";
    motor.y.title = "temperature, degC";
    motor.series = {line("median pace", way, of_each(stations, "motor_c"), 0),
                    line("slow pace", way, of_each(stations, "motor_slow_c"), 3)};
  }
  return draw_charts("The day", charts);
}

// Times in UTC and, on Mars, in local true solar time at the start.
struct DayClock {
  std::optional<double> east_longitude_rad;

  std::string words(std::int64_t utc_ms) const {
    std::string out = utc_words(utc_ms);
    if (!east_longitude_rad) return out;
    const long minutes = std::lround(60.0 * sky::mars_time(utc_ms, *east_longitude_rad).true_solar_h) % 1440;
    return out + fmt::format(" ({:02}:{:02} true solar time)", minutes / 60, minutes % 60);
  }
  // Of an arrival, told to the minute.
  std::string arrival(const JsonValue& drive, std::string_view key) const {
    return words(minute_after(time_of(drive, key)));
  }
};

DayClock clock_at_start(const Catalogue& catalogue, const JsonValue& sol, const JsonValue& request) {
  const auto site =
      terrain_at(catalogue, text(sol, "terrain"), text(at(at(sol, "plan"), "provenance"), "terrain_version"));
  if (!site || (*site)->info().body != "Mars") return {};
  const JsonValue& start = at(request, "start");
  const auto degrees = (*site)->degrees_at({number(start, "x_m"), number(start, "y_m")});
  if (!degrees) return {};
  return {rad_from_deg(degrees->x)};
}

void add_windows(ReportPage& page, const JsonValue& departures, const DayClock& clock) {
  for (const JsonValue& window : at(departures, "windows").elements) {
    const planner::DepartureWindow told = told_window(window);
    page.item(told.from_ms == told.to_ms ? "Depart at " + clock.words(told.from_ms)
                                         : fmt::format("Depart between {} and {}", clock.words(told.from_ms),
                                                       clock.words(told.to_ms)));
  }
}

void add_day(ReportPage& page, const JsonValue& departures, const JsonValue& asked, const DayClock& clock) {
  page.section("The day");
  add_windows(page, departures, clock);
  const JsonValue& drive = at(departures, has(departures, "best") ? "best" : "nearest");
  page.paragraph(fmt::format(
      "{} {}: the rover arrives at {}, at the slow pace at {}. The sun is over the horizon for "
      "{:.0f} % of the time. With {:.1f} % at the departure {}: {:.0f} Wh gained, {:.0f} Wh used, {:.0f} Wh "
      "spilled.{}",
      has(departures, "best") ? "Best at" : "The departure that breaks fewest rules of the day is",
      clock.words(time_of(drive, "departs")), clock.arrival(drive, "arrives"),
      clock.arrival(drive, "arrives_late"), 100.0 * number(drive, "lit_share"),
      number(asked, "charge_percent"), battery_words(drive, 1), number(drive, "gained_wh"),
      number(drive, "used_wh"), number(drive, "spilled_wh"),
      number(asked, "optical_depth") > 0.0
          ? fmt::format(" The optical depth of the air is {:g}.", number(asked, "optical_depth"))
          : std::string()));
  page.paragraph(std::string(kPaceWords));
  if (has(departures, "halt"))
    page.paragraph(
        fmt::format("Wait for {:.1f} h at {:.1f} m to charge: without it no departure keeps the rules of the "
                    "day. The commands hold no wait: split the one that is under way there, and wait between "
                    "its parts.",
                    number(at(departures, "halt"), "hours"), number(at(departures, "halt"), "at_m")));
  page.picture(
      {"day", day_charts(departures, drive)},
      "Along the way from the departure above; \"By departure\": every departure that was tried; "
      "\"Hottest drive motor\", where it is shown: at each place by the losses of the wheel that loses "
      "most there, so no wheel's motor is warmer");
  page.table({"rule of the day", "verdict"});
  for (const JsonValue& rule : at(drive, "rules").elements)
    page.row({text(rule, "words"), std::string(planner::verdict_words(text(rule, "verdict")))});
}

// The drive from other starts, where the start has an error.
void add_start(ReportPage& page, const JsonValue& decision) {
  if (!has(decision, "starts")) return;
  const JsonValue& starts = at(decision, "starts");
  page.section("If it does not start where it is said to");
  for (const JsonValue& rule : at(decision, "rules").elements)
    if (text(rule, "rule") == "start")
      page.paragraph(
          fmt::format("{}: {}.", planner::verdict_words(text(rule, "verdict")), text(rule, "words")));
  page.table({"starts", "GO", "UNKNOWN", "NO-GO"});
  page.row({fmt::format("{:.0f}", number(starts, "starts")), fmt::format("{:.0f}", number(starts, "go")),
            fmt::format("{:.0f}", number(starts, "unknown")),
            fmt::format("{:.0f}", number(starts, "no_go"))});
}

void add_checks(ReportPage& page, const JsonValue& sol) {
  page.section("Where to check the slip");
  const JsonValue& checks = at(sol, "checks");
  page.paragraph(fmt::format("{}. {}", assumed_checks_words(at(at(sol, "plan"), "request")),
                             checks.elements.empty()
                                 ? "On no stretch is a halt likely enough to name a place."
                                 : "At these places a check matters most:"));
  for (const JsonValue& check : checks.elements)
    page.item(fmt::format("{}, at ({:.1f}, {:.1f}): {}", check_place_words(number(check, "at_m")),
                          number(check, "x_m"), number(check, "y_m"), text(check, "why")));
}

void add_command_table(ReportPage& page, const JsonValue& commands, const JsonValue& checks) {
  page.table({"from - to", "command", "slip"});
  for (const CommandRow& row : command_rows(commands, checks))
    page.row({way_words(row), row.words, row.checks});
}

// The way back out of the worst place, with its commands where the document has them.
void add_way_back(ReportPage& page, const JsonValue& back, const DayClock& clock) {
  const JsonValue& request = at(back, "request");
  const std::string begun = has(request, "departure")
                                ? fmt::format(", begun at the slow pace at {} with {:.0f} % in the battery,",
                                              clock.words(time_of(at(request, "departure"), "from")),
                                              number(at(request, "departure"), "charge_percent"))
                                : std::string();
  page.paragraph(
      fmt::format("Backing out of it to the start{} is {}: {}. Its distances count from the worst place.",
                  begun, planner::verdict_words(text(back, "verdict")),
                  at(back, "reasons").elements.empty() ? std::string("no reason")
                                                       : at(back, "reasons").elements.front().text));
  if (!has(request, "commands")) return;
  page.paragraph(fmt::format("{}{}. The commands of the way back:", start_words(at(request, "start")),
                             at(request, "backwards").boolean ? ", driven backwards" : ""));
  add_command_table(page, at(request, "commands"), {});
}

void add_places(ReportPage& page, const JsonValue& sol, const JsonValue& departures, const DayClock& clock) {
  page.section("If it does not come to the end");
  if (has(sol, "time_runs_out"))
    page.paragraph(fmt::format("When the time is over: {}. {}", place_words(at(sol, "time_runs_out")),
                               sentence(text(at(sol, "time_runs_out"), "why"))));
  if (const auto in_time = in_time_words(at(departures, has(departures, "best") ? "best" : "nearest")))
    page.paragraph(fmt::format("The time is enough: {}.", *in_time));
  if (has(sol, "worst"))
    page.paragraph(fmt::format("The worst place: {}. {}", place_words(at(sol, "worst")),
                               sentence(text(at(sol, "worst"), "why"))));
  else
    page.paragraph("No draw of the ground halts the rover.");
  if (has(sol, "back_out"))
    add_way_back(page, at(sol, "back_out"), clock);
  else if (has(sol, "no_way_back"))
    page.paragraph(fmt::format("No way back was checked: {}.", text(sol, "no_way_back")));
}

void add_commands(ReportPage& page, const JsonValue& route, const JsonValue& checks) {
  page.section("Commands");
  if (text(route, "verdict") != "go")
    page.paragraph("The route is not a GO: these commands are for reading, not for driving.");
  page.paragraph(fmt::format("{}. {}", start_words(at(route, "start")), kCommandSigns));
  add_command_table(page, at(route, "commands"), checks);
}

}  // namespace

Result<std::string> sol_report(const Catalogue& catalogue, std::string_view document) {
  const auto sol = json::parse(document, {.bytes = document.size(), .values = document.size()});
  if (!sol) return fail(sol.error());
  ReportPage page(fmt::format("A sol of {} on {}", text(*sol, "rover"), text(*sol, "terrain")));
  add_verdict_banner(page, *sol);
  for (const JsonValue& reason : at(*sol, "reasons").elements) page.item(reason.text);
  const JsonValue& plan = at(*sol, "plan");
  const auto& summary = at(plan, "summary").elements;
  if (summary.empty()) return page.html();
  const JsonValue& route = summary.front();
  const JsonValue& decision =
      at(at(at(at(plan, "routes"), "features").elements.front(), "properties"), "decision");
  add_advice(page, decision);
  const long minutes = std::lround(number(route, "duration_s") / 60.0);
  page.paragraph(
      fmt::format("{:.1f} m in {}:{:02d} h of driving with {:.0f} Wh of the drive motors on the soils as "
                  "they are believed on average; the day below takes the draws of the ground.",
                  number(route, "length_m"), minutes / 60, minutes % 60,
                  has(route, "energy_wh") ? number(route, "energy_wh") : 0.0));
  json::Writer w;
  json::write_value(w, plan);
  add_map(page, draw_route_map(catalogue, w.take()), "The routes of the plan, by slip");
  const DayClock clock = clock_at_start(catalogue, *sol, at(plan, "request"));
  if (has(decision, "departures"))
    add_day(page, at(decision, "departures"), at(at(plan, "request"), "departure"), clock);
  add_start(page, decision);
  add_checks(page, *sol);
  add_places(page, *sol, at(decision, "departures"), clock);
  add_commands(page, route, at(*sol, "checks"));
  add_provenance(page, plan);
  return page.html();
}

}  // namespace slipway::api
