#pragma once

#include "sim/effects/effect.h"

namespace slipway::sim {

// The centre of mass lies elsewhere than the rover file says: a moved payload, an extended arm, a drained
// tank.
extern const Effect kComOffset;

}  // namespace slipway::sim
