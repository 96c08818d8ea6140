#pragma once

#include <span>
#include <string>
#include <string_view>

#include "api/requests/plan_request.h"
#include "core/result.h"

namespace slipway::api::json {

// Errors only where the bytes are no JSON document; everything else is a fault in the reading.
// `costs`: the terms whose weights the request may set.
Result<Reading<PlanRequest>> read_plan_request(
    std::string_view bytes, std::span<const planner::CostTerm> costs = planner::cost_catalogue());

// Whole, with every default filled in: what it gives reads back as the same request.
std::string write_plan_request(const PlanRequest& request);

}  // namespace slipway::api::json
