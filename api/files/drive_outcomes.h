#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "planner/problem/problem.h"

namespace slipway::api {

// How a drive of the past ended.
enum class PastOutcome {
  kCompleted,
  kSlipStop,      // halted by the check of its slip
  kStoppedOther,  // halted by something else: up to there, no stop by slip
  kNoReport,      // nothing is known of its end
};

struct PastDrive {
  int sol = 0;
  PastOutcome outcome = PastOutcome::kNoReport;
  std::vector<planner::Waypoint> path;   // as far as it was driven
  std::optional<double> planned_m = {};  // length that was planned, where a report gives it
};

// A table of drives on a terrain (drive-outcomes/1): what was driven is evidence of the ground.
struct DriveOutcomeTable {
  std::string rover;              // that drove
  std::vector<PastDrive> drives;  // by sol
};

// Errors: unreadable_data with every fault.
Result<DriveOutcomeTable> read_drive_outcomes(std::string_view bytes);

}  // namespace slipway::api
