#pragma once

#include <vector>

#include "api/json/strict_reader.h"
#include "api/json/writer.h"
#include "api/requests/plan_request.h"

namespace slipway::api::json {

// The keys that plan and prediction requests share, in the object of the request itself.
void read_drive_assumptions(ObjectReader& reader, DriveAssumptions& drive);
void write_drive_assumptions(Writer& w, const DriveAssumptions& drive);

// {"x_m": 1, "y_m": 2, "yaw_deg": 90}, the heading only where it matters.
void read_waypoint(const JsonValue& value, const std::string& pointer, planner::Waypoint& out,
                   std::vector<Fault>& faults);
void write_waypoint(Writer& w, const planner::Waypoint& waypoint);

// The place where a drive under way is now, with its heading where that is known; nothing without one.
std::optional<planner::Waypoint> place_reached(const DriveAssumptions& drive);

// A path of one corner leads there from where a drive under way is.
void go_on_from_place_reached(const DriveAssumptions& drive, std::vector<planner::Waypoint>& path);

// "terrain" and "rover": names that the service resolves.
void read_names(ObjectReader& reader, std::string& terrain, std::string& rover);

}  // namespace slipway::api::json
