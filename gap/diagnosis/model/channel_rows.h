#pragma once

#include "gap/diagnosis/model/channel.h"

namespace slipway::gap {

// The channels, one row each; what they are stands beside Channel.
extern const ChannelRow kSlipChannel, kSideSlipChannel, kYawRateChannel, kRollChannel, kPitchChannel,
    kCurrentChannel, kSinkageChannel;

}  // namespace slipway::gap
