#pragma once

#include <vector>

#include "api/json/strict_reader.h"
#include "api/json/writer.h"
#include "sim/rover/effect_setting.h"

namespace slipway::api::json {

// The list "effects" of a request or a rover's file:
// [{"name": "grousers", "on": true, "parameters": {"height_m": 0.01}}]. Which names there are, which
// parameters and their ranges, is the effect catalogue's to say (sim::faults_of).
void read_effects(ObjectReader& reader, std::vector<sim::EffectSetting>& effects);
void write_effects(Writer& w, const std::vector<sim::EffectSetting>& effects);

}  // namespace slipway::api::json
