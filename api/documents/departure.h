#pragma once

#include <optional>

#include "api/json/strict_reader.h"
#include "api/json/writer.h"
#include "api/requests/plan_request.h"
#include "planner/problem/departure.h"

namespace slipway::api::json {

// "departure" of a request: when the drive may begin, and what must hold till it ends.
void read_departure(ObjectReader& reader, std::optional<DepartureRequest>& out);
void write_departure(Writer& w, const DepartureRequest& departure);

// "departures" of a decision: windows, the best departure with what is along it, and each that was tried.
void write_departures(Writer& w, const planner::Departures& departures);

}  // namespace slipway::api::json
