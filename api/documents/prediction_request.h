#pragma once

#include <string>
#include <string_view>

#include "api/requests/prediction_request.h"
#include "core/result.h"

namespace slipway::api::json {

// Errors only where the bytes are no JSON document; everything else is a fault in the reading.
Result<Reading<PredictionRequest>> read_prediction_request(std::string_view bytes);

// Whole, with every default filled in.
std::string write_prediction_request(const PredictionRequest& request);

}  // namespace slipway::api::json
