#pragma once

#include "sim/effects/effect.h"

namespace slipway::sim {

// A slipping wheel digs itself in: the sinkage exponent rises with slip.
extern const Effect kSlipSinkage;

}  // namespace slipway::sim
