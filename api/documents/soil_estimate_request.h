#pragma once

#include <string_view>

#include "api/requests/plan_request.h"
#include "api/requests/soil_estimate.h"
#include "core/result.h"

namespace slipway::api::json {

// Errors only where the bytes are no JSON document; everything else is a fault in the reading. Whether there
// are such a soil, rover and campaign is the service's to say.
Result<Reading<SoilEstimateRequest>> read_soil_estimate_request(std::string_view bytes);

}  // namespace slipway::api::json
