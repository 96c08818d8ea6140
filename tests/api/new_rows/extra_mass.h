#pragma once

#include "sim/effects/effect.h"

namespace slipway::sim {

// The rover carries more than its file says.
extern const Effect kExtraMass;

}  // namespace slipway::sim
