#pragma once

#include "gap/diagnosis/model/channel.h"

namespace slipway::gap {

// The rate at which a wheel turns, by a second encoder.
extern const ChannelRow kWheelRateChannel;

}  // namespace slipway::gap
