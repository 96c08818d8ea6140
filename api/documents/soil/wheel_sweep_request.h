#pragma once

#include <string>
#include <string_view>

#include "api/requests/plan_request.h"
#include "api/requests/wheel_sweep_request.h"
#include "core/result.h"

namespace slipway::api::json {

// Errors only where the bytes are no JSON document; everything else is a fault in the reading. A range of a
// sweep is kept as its values.
Result<Reading<WheelSweepRequest>> read_wheel_sweep_request(std::string_view bytes);

// Whole, with what defaults have filled in.
std::string write_wheel_sweep_request(const WheelSweepRequest& request);

}  // namespace slipway::api::json
