#pragma once

#include "sim/effects/effect.h"

namespace slipway::sim {

// A smooth rim slides on the soil before the soil shears.
extern const Effect kSmoothRim;

}  // namespace slipway::sim
