#pragma once

#include "sim/effects/effect.h"

namespace slipway::sim {

// Soil pushed before a sunk wheel; see bulldozing_law.h.
extern const Effect kBulldozing;

}  // namespace slipway::sim
