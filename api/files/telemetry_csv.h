#pragma once

#include <string_view>

#include "core/result.h"
#include "planner/problem/drive_so_far.h"

namespace slipway::api {

// The telemetry of a drive under way as a CSV with a header: driven_m, x_m, y_m; where they are known time_s,
// yaw_deg, current_a (the sum over the drive motors, the mean since the row before) or WHEEL_current_a for
// each wheel. A cell may be empty where its column may be missing. Noises are the usual ones. Errors:
// unreadable_data with every fault and its line.
Result<planner::DriveSoFar> read_telemetry_csv(std::string_view bytes, std::string_view file);

}  // namespace slipway::api
