#pragma once

#include "sim/effects/effect.h"

namespace slipway::sim {

// The steered wheels stand at another angle than commanded.
extern const Effect kSteeringOffset;

}  // namespace slipway::sim
