#pragma once

#include <string>
#include <string_view>

#include "api/documents/drive_series.h"
#include "api/requests/answers.h"
#include "core/result.h"

namespace slipway::api::json {

// "plan/1": request with every default, figures per route, and the routes as GeoJSON with their series. The
// same answer gives the same bytes. Throws std::domain_error where a number is not finite.
std::string write_plan_answer(const PlanAnswer& answer, StationDetail detail = StationDetail::kThinned);

// The GeoJSON member of a "plan/1", "prediction/1" or "diagnosis/1" document, alone.
Result<std::string> geojson_of(std::string_view answer);

}  // namespace slipway::api::json
