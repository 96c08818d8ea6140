#pragma once

#include "sim/effects/effect.h"

namespace slipway::sim {

// Friction in the gearbox beyond what the rover file's efficiency and no-load current include.
extern const Effect kGearboxFriction;

}  // namespace slipway::sim
