#pragma once

#include "api/chart/chart.h"
#include "api/json/json_value.h"

namespace slipway::api {

// Slip, sinkage, current and tilt along the way of a "check/1" document with their limits, and stops,
// embeddings and the rover's position error by stretch.
NamedChart draw_check(const json::JsonValue& check);

}  // namespace slipway::api
