#pragma once

#include "sim/effects/effect.h"

namespace slipway::sim {

// Whether soil parameters measured under one gravity hold under another: k_c and k_phi times (g / g0)^a.
// Left off, they hold as they are, which Wong found for Apollo and Kobayashi in parabolic flight; a = 1 is
// the bearing capacity of dry sand.
extern const Effect kSoilGravity;

}  // namespace slipway::sim
