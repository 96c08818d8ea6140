#pragma once

#include "sim/effects/effect.h"

namespace slipway::sim {

// The true attitude differs from the map's or the inclinometer's.
extern const Effect kAttitudeBias;

}  // namespace slipway::sim
