#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "sim/rover/effect_setting.h"
#include "sim/rover/rover_model.h"

namespace slipway::campaign {

// Names of the effects that a sealed campaign can hide: those whose row has a hidden size, in the catalogue's
// order.
std::vector<std::string_view> hidden_effects();

// An effect of hidden_effects() at a size, in multiples of the usual one; whatever has a side, a sign or a
// wheel draws it by `key`. An effect with a region has no place yet.
sim::EffectSetting hidden_effect(std::string_view name, double size, std::uint64_t key,
                                 const sim::RoverModel& rover);

}  // namespace slipway::campaign
