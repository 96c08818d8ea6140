#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "api/json/strict_reader.h"
#include "api/requests/diagnosis_request.h"
#include "api/requests/plan_request.h"
#include "core/result.h"

namespace slipway::api::json {

// "without" and "seed", which requests for a diagnosis have in common.
void read_search_keys(ObjectReader& reader, std::vector<std::string>& without, std::uint64_t& seed);

// Errors only where the bytes are no JSON document; everything else is a fault in the reading. Whether there
// is such a campaign is the service's to say.
Result<Reading<DiagnosisRequest>> read_diagnosis_request(std::string_view bytes);

// The same of a request as it is recorded, with the model in it: see model_reference.h.
Result<Reading<ModelCheckRequest>> read_model_check_request(std::string_view bytes);

}  // namespace slipway::api::json
