#include "api/report/command_rows.h"

#include <fmt/format.h>

#include <algorithm>

#include "api/json/lookup.h"

namespace slipway::api {
namespace {

using json::at;
using json::has;
using json::JsonValue;
using json::number;

constexpr double kSamePlace_m = 0.05;  // distances are told to 0.1 m

std::string words_of(const JsonValue& command) {
  if (has(command, "turn_deg")) return fmt::format("turn {:g} deg in place", number(command, "turn_deg"));
  if (has(command, "arc_m"))
    return fmt::format("arc {:g} m, radius {:g} m", number(command, "arc_m"), number(command, "radius_m"));
  return fmt::format("drive {:g} m", number(command, "drive_m"));
}

// Of the checks between the row's ends; one at its end belongs to the next command.
std::string checks_within(const CommandRow& row, const JsonValue& checks) {
  std::string words;
  for (const JsonValue& check : checks.elements) {
    const double into_m = number(check, "at_m") - row.from_m;
    if (into_m < -kSamePlace_m || into_m >= row.to_m - row.from_m - kSamePlace_m) continue;
    words += words.empty() ? "check the slip " : ", ";
    words += into_m > kSamePlace_m        ? fmt::format("after {:.1f} m of it", into_m)
             : row.from_m <= kSamePlace_m ? std::string("at the start")
                                          : std::string("before it");
  }
  return words;
}

}  // namespace

std::vector<CommandRow> command_rows(const JsonValue& commands, const JsonValue& checks) {
  std::vector<CommandRow> rows;
  double at_m = 0.0;
  for (const JsonValue& command : commands.elements) {
    const double times = has(command, "repeat") ? number(command, "repeat") : 1.0;
    CommandRow row{.from_m = at_m, .to_m = at_m, .words = words_of(command), .checks = {}};
    row.to_m += times * (number(command, "drive_m") + number(command, "arc_m"));
    if (times > 1.0) row.words += fmt::format(", {:.0f} times", times);
    row.checks = checks_within(row, checks);
    at_m = row.to_m;
    rows.push_back(std::move(row));
  }
  return rows;
}

std::string way_words(const CommandRow& row) {
  return row.to_m > row.from_m ? fmt::format("{:.2f} - {:.2f} m", row.from_m, row.to_m)
                               : fmt::format("{:.2f} m", row.from_m);
}

std::string start_words(const JsonValue& start) {
  std::string words =
      fmt::format("Start at ({:.2f}, {:.2f}) m of the map", number(start, "x_m"), number(start, "y_m"));
  if (has(start, "yaw_deg")) words += fmt::format(", heading {:.6g} deg", number(start, "yaw_deg"));
  return words;
}

std::string check_place_words(double at_m) {
  return at_m < kSamePlace_m ? std::string("at the start") : fmt::format("before {:.1f} m", at_m);
}

std::string assumed_checks_words(const JsonValue& request) {
  return fmt::format(
      "The verdict assumes that the slip is checked every {:g} m that the wheels roll, on the whole way",
      number(at(request, "checks"), "slip_check_every_m"));
}

}  // namespace slipway::api
