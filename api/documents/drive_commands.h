#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "api/files/commands_csv.h"
#include "api/json/strict_reader.h"
#include "api/json/writer.h"
#include "core/result.h"
#include "planner/problem/drive_step.h"

namespace slipway::api::json {

// "commands": a list of {"drive_m": 5}, {"arc_m": 4, "radius_m": 6} and {"turn_deg": -30}, each with "repeat"
// where it is done again. What is wrong is added to the reader's faults.
void read_commands(ObjectReader& reader, std::vector<planner::DriveStep>& commands);

// The same without repeats. Numbers read back as the same doubles.
void write_commands(Writer& w, const std::vector<planner::DriveStep>& commands);

// "start" and "commands" of a route.
void write_drive_steps(Writer& w, const planner::DriveSteps& steps);

// The request of a check of a plan's route: terrain, rover, start and commands, and all that the plan's
// request assumes of a drive. `plan`: the plan's answer. Errors: invalid_request at /route where it has none
// of this rank.
Result<std::string> check_of_route(const JsonValue& plan, int route);

// A route's commands as a table, see commands_csv.h. Errors as above.
Result<std::string> commands_table(const JsonValue& plan, int route);

// The request of a check of the commands of a table.
std::string check_of_table(const CommandsTable& table);

}  // namespace slipway::api::json
