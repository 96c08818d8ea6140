#pragma once

#include "api/json/writer.h"
#include "api/requests/wheel_sweep_request.h"

namespace slipway::api::json {

// The members "columns" and "rows" of a wheel sweep's answer where the whole rover is on the slope.
void write_rover_columns(Writer& w, const WheelSweepAnswer& answer);
void write_rover_rows(Writer& w, const WheelSweepAnswer& answer);

}  // namespace slipway::api::json
