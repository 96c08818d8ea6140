#pragma once

#include <optional>

#include "api/json/strict_reader.h"
#include "api/json/writer.h"
#include "api/requests/answers.h"

namespace slipway::api::json {

// The key "drive_so_far" of a request: the telemetry of a drive under way.
void read_drive_so_far(ObjectReader& reader, std::optional<planner::DriveSoFar>& drive);
void write_drive_so_far(Writer& w, const planner::DriveSoFar& drive);

// What it taught, as a member of an answer where there was one: each stretch with its measured slip and what
// was predicted of it before.
void write_learnt_drive(Writer& w, const std::optional<LearntDrive>& learnt, const DriveAssumptions& drive);

}  // namespace slipway::api::json
