#pragma once

#include "sim/effects/effect.h"

namespace slipway::sim {

// A crust on loose soil that carries until it breaks; see duricrust_law.h.
extern const Effect kDuricrust;

}  // namespace slipway::sim
