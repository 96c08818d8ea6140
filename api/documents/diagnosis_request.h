#pragma once

#include <string_view>

#include "api/requests/diagnosis_request.h"
#include "api/requests/plan_request.h"
#include "core/result.h"

namespace slipway::api::json {

// Errors only where the bytes are no JSON document; everything else is a fault in the reading. Whether there
// is such a campaign is the service's to say.
Result<Reading<DiagnosisRequest>> read_diagnosis_request(std::string_view bytes);

}  // namespace slipway::api::json
