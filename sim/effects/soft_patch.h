#pragma once

#include "sim/effects/effect.h"

namespace slipway::sim {

// A place where the soil is weaker than the map says.
extern const Effect kSoftPatch;

}  // namespace slipway::sim
