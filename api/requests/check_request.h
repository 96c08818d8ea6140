#pragma once

#include <optional>
#include <string>
#include <vector>

#include "api/requests/plan_request.h"
#include "planner/problem/drive_step.h"

namespace slipway::api {

// POST /v1/checks asks whether a drive may be commanded: GO, NO-GO or UNKNOWN, with the place and the reason.
struct CheckRequest {
  std::string terrain;
  std::string rover;
  std::vector<planner::Waypoint> path;  // corners; of a command sequence its start alone
  std::vector<planner::DriveStep> commands;
  std::string rules;  // name of a file of rules; empty: none
  planner::Manner manner;
  std::vector<planner::Polygon> keep_out;  // a drive that enters one is a NO-GO
  std::vector<planner::Polygon> keep_in;   // as is one that leaves one of these
  DriveAssumptions drive;
};

}  // namespace slipway::api
