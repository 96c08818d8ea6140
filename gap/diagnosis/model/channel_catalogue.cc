#include <array>

#include "gap/diagnosis/model/channel_rows.h"

namespace slipway::gap {

// In the order of Channel: the list that a new row is added to. Nothing else stands in this file, so that a
// test can link a catalogue of its own.
std::span<const ChannelRow> channel_catalogue() {
  static const std::array kRows{kSlipChannel,  kSideSlipChannel, kYawRateChannel, kRollChannel,
                                kPitchChannel, kCurrentChannel,  kSinkageChannel};
  return kRows;
}

}  // namespace slipway::gap
