#pragma once

#include "api/json/strict_reader.h"
#include "sim/rover/wheel_failure.h"

namespace slipway::api::json {

// "failed_wheels": {"rf": "locked"}, of requests and of a campaign table's drives. Whether the rover has such
// wheels is not asked here.
void read_failed_wheels(ObjectReader& reader, sim::FailedWheels& failed);

}  // namespace slipway::api::json
