#pragma once

#include "sim/effects/effect.h"

namespace slipway::sim {

// What a motor draws depends on its temperature; see motor.h.
extern const Effect kMotorTemperature;

}  // namespace slipway::sim
