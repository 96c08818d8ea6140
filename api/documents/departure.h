#pragma once

#include <optional>
#include <vector>

#include "api/json/strict_reader.h"
#include "api/json/writer.h"
#include "api/requests/plan_request.h"
#include "planner/problem/departure.h"
#include "sky/sky.h"

namespace slipway::api::json {

// "departure" of a request: when the drive may begin, and what must hold till it ends.
void read_departure(ObjectReader& reader, std::optional<DepartureRequest>& out);
void write_departure(Writer& w, const DepartureRequest& departure);
// The list "sky" of a departure.
void write_sky(Writer& w, const std::vector<sky::SkySample>& moments);

// "departures" of a decision: windows, the best departure with what is along it, and each that was tried.
void write_departures(Writer& w, const planner::Departures& departures);

}  // namespace slipway::api::json
