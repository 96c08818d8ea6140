#pragma once

#include "sim/effects/effect_catalogue.h"

namespace slipway::sim {

// Cleats on the rims; see grouser_law.h.
extern const Effect kGrousers;

}  // namespace slipway::sim
