#pragma once

#include "sim/effects/effect.h"

namespace slipway::sim {

// Soil pushed aside by a wheel's side wall; see terzaghi.h.
extern const Effect kSideBulldozing;

}  // namespace slipway::sim
