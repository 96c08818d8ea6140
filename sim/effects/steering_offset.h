#pragma once

#include "sim/effects/effect_catalogue.h"

namespace slipway::sim {

// The steered wheels stand at another angle than told.
extern const Effect kSteeringOffset;

}  // namespace slipway::sim
