#pragma once

#include <string>
#include <vector>

#include "api/json/json_value.h"

namespace slipway::api {

// One command of a sequence as people drive it.
struct CommandRow {
  double from_m = 0.0, to_m = 0.0;  // along the way; the same of a turn in place
  std::string words;                // "arc 1.22 m, radius -6.04 m"
  std::string checks;  // where the slip is to be checked in it: "after 0.4 m of it"; mostly empty
};

// Of the list "commands" of a route or a request. `checks`: the places ("at_m") before which the slip is to
// be checked.
std::vector<CommandRow> command_rows(const json::JsonValue& commands, const json::JsonValue& checks);

// "0.00 - 14.91 m", of a turn in place "14.91 m".
std::string way_words(const CommandRow& row);

// "Start at (8142579.73, -276648.74) m of the map, heading 162.6 deg": a pose from which commands are driven.
std::string start_words(const json::JsonValue& start);
// How the numbers of poses and commands count.
inline constexpr std::string_view kCommandSigns =
    "Headings count from the map's x axis; headings, turns and radii are positive to the left.";

// A place at which the slip is to be checked: "at the start", "before 34.0 m".
std::string check_place_words(double at_m);

// What the verdict assumes of slip checks. `request`: of a plan or a check, with "checks".
std::string assumed_checks_words(const json::JsonValue& request);

}  // namespace slipway::api
