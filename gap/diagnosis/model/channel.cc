#include "gap/diagnosis/model/channel.h"

namespace slipway::gap {

std::size_t channel_count() {
  return channel_catalogue().size();
}

const ChannelRow& row_of(Channel channel) {
  return channel_catalogue()[static_cast<std::size_t>(channel)];
}

std::string_view name_of(Channel channel) {
  return row_of(channel).name;
}

std::string_view unit_of(Channel channel) {
  return row_of(channel).unit;
}

double boundary_unit(Channel channel) {
  return row_of(channel).boundary_unit;
}

}  // namespace slipway::gap
