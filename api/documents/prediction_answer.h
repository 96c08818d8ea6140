#pragma once

#include <string>

#include "api/documents/drive_series.h"
#include "api/requests/answers.h"

namespace slipway::api::json {

// "prediction/1": request with every default, the figures, and the path as GeoJSON with its series. The same
// answer gives the same bytes. Throws std::domain_error where a number is not finite.
std::string write_prediction_answer(const PredictionAnswer& answer,
                                    StationDetail detail = StationDetail::kThinned);

}  // namespace slipway::api::json
