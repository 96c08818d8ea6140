#pragma once

#include "sim/effects/effect_catalogue.h"

namespace slipway::sim {

// Friction in the gearbox besides what the file's efficiency and no-load current hold.
extern const Effect kGearboxFriction;

}  // namespace slipway::sim
