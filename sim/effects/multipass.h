#pragma once

#include "sim/effects/effect_catalogue.h"

namespace slipway::sim {

// Later wheels meet soil that earlier ones compacted; see sim/multipass.h for who follows whom and how
// deep the rut gets.
extern const Effect kMultipass;

}  // namespace slipway::sim
