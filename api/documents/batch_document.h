#pragma once

#include <string>
#include <string_view>

#include "api/requests/batch_request.h"
#include "api/requests/plan_request.h"
#include "core/result.h"

namespace slipway::api::json {

// With each request for each of the seeds, where there are some. Errors only where the bytes are no JSON
// document; everything else is a fault in the reading. The requests themselves are not looked into.
Result<Reading<BatchRequest>> read_batch_request(std::string_view bytes);

// "batch/1": how many answers there are, and of which verdicts. The answers are kept beside it.
std::string write_batch_answer(const BatchAnswer& answer);

}  // namespace slipway::api::json
