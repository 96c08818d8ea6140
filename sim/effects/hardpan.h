#pragma once

#include "sim/effects/effect.h"

namespace slipway::sim {

// A stiff layer under loose soil; see hardpan_law.h.
extern const Effect kHardpan;

}  // namespace slipway::sim
