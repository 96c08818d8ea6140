#pragma once

#include "sim/effects/effect.h"

namespace slipway::sim {

extern const Effect kDigging;

}  // namespace slipway::sim
