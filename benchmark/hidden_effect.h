#pragma once

#include <span>
#include <string_view>

#include "sim/rover/effect_setting.h"
#include "sim/rover/rover_model.h"

namespace slipway::campaign {

// Effects of the library that a sealed campaign can hide: all but those that the drives of one place can't
// tell from soil parameters (soil_gravity, smooth_rim).
std::span<const std::string_view> hidden_effects();

// An effect of hidden_effects() at a size, in multiples of the usual one; what has a side, a sign or a wheel
// draws it by `key`. A soft patch has no place yet.
sim::EffectSetting hidden_effect(std::string_view name, double size, std::uint64_t key,
                                 const sim::RoverModel& rover);

}  // namespace slipway::campaign
