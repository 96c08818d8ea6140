#pragma once

#include <vector>

#include "api/chart/chart.h"
#include "api/json/json_value.h"

namespace slipway::api {

// Slip, sinkage, current and tilt along the way of a "check/1" document with their limits as one picture;
// stops, embeddings and the rover's position error by stretch as another.
std::vector<NamedChart> draw_check(const json::JsonValue& check);

}  // namespace slipway::api
