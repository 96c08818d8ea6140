#pragma once

#include <vector>

#include "api/json/strict_reader.h"
#include "sim/single_wheel/wheel_sweep.h"

namespace slipway::api::json {

// "set": {"soil.n": 1.1, "c1@wet": 0.4}, which may be left out; which names there are and their ranges is for
// whoever the settings are given to.
void read_settings(ObjectReader& reader, std::vector<sim::SweepSetting>& set);

}  // namespace slipway::api::json
