#pragma once

#include "sim/effects/effect_catalogue.h"

namespace slipway::sim {

// A smooth rim slides on the soil before the soil shears.
extern const Effect kSmoothRim;

}  // namespace slipway::sim
