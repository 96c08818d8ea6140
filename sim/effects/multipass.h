#pragma once

#include "sim/effects/effect.h"

namespace slipway::sim {

// Wheels behind others meet soil that those have compacted; sim/rover/multipass.h says which wheel follows
// which, and how deep the rut gets.
extern const Effect kMultipass;

}  // namespace slipway::sim
