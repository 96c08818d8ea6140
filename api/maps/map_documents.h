#pragma once

#include <string>
#include <string_view>

#include "api/requests/map_request.h"
#include "core/result.h"

namespace slipway::api::json {

// Errors only where the bytes are no JSON document; everything else is a fault in the reading.
Result<Reading<MapRequest>> read_map_request(
    std::string_view bytes, std::span<const planner::CostTerm> costs = planner::cost_catalogue());
// Whole, with every default filled in.
std::string write_map_request(const MapRequest& request);

// "map/1": what the map shows and where, its figures, and how to read its cells.
std::string write_map_answer(const MapAnswer& answer);

}  // namespace slipway::api::json
