#pragma once

#include "sim/effects/effect.h"

namespace slipway::sim {

// The shear modulus changes with the speed of the rim: K = K0 (v / v0)^a.
extern const Effect kRateShear;

}  // namespace slipway::sim
