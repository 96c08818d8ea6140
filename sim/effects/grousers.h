#pragma once

#include "sim/effects/effect.h"

namespace slipway::sim {

// Cleats on the rims; see grouser_law.h.
extern const Effect kGrousers;

}  // namespace slipway::sim
