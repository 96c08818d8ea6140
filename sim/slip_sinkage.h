#pragma once

#include "sim/effect_catalogue.h"

namespace slipway::sim {

// Slip sinkage [Ding et al. 2010; ARTEMIS eq. 22]: a slipping wheel digs, modelled as n = n0 + n1 |i|. With
// depths below a metre a larger exponent is a smaller pressure, so the wheel sinks until it is carried again.
extern const Effect kSlipSinkage;

}  // namespace slipway::sim
