#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "planner/problem/drive_step.h"
#include "planner/problem/problem.h"

namespace slipway::api {

// A command sequence as a table: comments with the terrain, the rover and the pose at which it begins, then a
// row for each command, with lengths and radii in metres (left positive) and turns in degrees (likewise):
//
//   # terrain: gale
//   # rover: msl-class
//   # start_x_m: 8142640
//   # start_y_m: -276640
//   # start_yaw_deg: 172.9
//   command,value,radius_m
//   drive,10.2,
//   arc,3.14,-6.05
//   turn,30,
struct CommandsTable {
  std::string terrain = {}, rover = {};  // empty: the file does not say it
  planner::Waypoint start = {};          // with a heading
  std::vector<planner::DriveStep> commands = {};
  std::vector<std::size_t> lines = {};  // of the commands in the file, where it was read from one
};

std::string write_commands_csv(const CommandsTable& table);

// `file`: its name, in the places of faults: "route.csv, line 7, column 2". Other comments are passed over.
// Errors: invalid_request with every fault.
Result<CommandsTable> read_commands_csv(std::string_view bytes, std::string_view file);

}  // namespace slipway::api
