#pragma once

#include "sim/effects/effect.h"

namespace slipway::sim {

// One wheel that turns slower than commanded, or not at all, or against a brake: a failing actuator.
extern const Effect kDraggingWheel;

}  // namespace slipway::sim
