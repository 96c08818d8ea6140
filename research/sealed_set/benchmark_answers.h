#pragma once

#include <string_view>
#include <vector>

#include "core/result.h"
#include "research/benchmark/benchmark_score.h"

namespace slipway::api::json {

// answers.json of a folder of campaigns: what was hidden in each, by the campaign's folder. Of each,
// `effects` (names with their parameters) must be there; `fidelity`, `kind`, `size`, `nominal` ("true" or
// "near": nothing is off) and `place` may be. Other keys are passed over. Errors: malformed_json,
// invalid_request.
Result<std::vector<gap::HiddenAnswer>> read_benchmark_answers(std::string_view bytes);

}  // namespace slipway::api::json
