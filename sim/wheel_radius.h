#pragma once

#include "sim/effect_catalogue.h"

namespace slipway::sim {

// Every wheel's effective radius differs from the file's: worn, bent or clogged wheels, or a soft carcass.
// Axles keep their place in the body; the rover stands higher or lower by the difference.
extern const Effect kWheelRadius;

}  // namespace slipway::sim
