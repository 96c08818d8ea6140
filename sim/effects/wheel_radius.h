#pragma once

#include "sim/effects/effect.h"

namespace slipway::sim {

// The wheels' effective radius differs from the file's; the rover's own software goes on reckoning with the
// file's.
extern const Effect kWheelRadius;

}  // namespace slipway::sim
