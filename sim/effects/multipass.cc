#include "sim/effects/multipass.h"

#include <array>

namespace slipway::sim {
namespace {

constexpr std::array kFields{
    Field{"stiffening", "1", "a track is 1 + this times as stiff as fresh soil", 0.0, 5.0, 0.9, 0.0},
};

void change(std::span<const double> values, Soil& soil) {
  soil.multipass_stiffening = values[0];
}

}  // namespace

constexpr Effect kMultipass{
    .name = "multipass",
    .summary = "later wheels run in the tracks of earlier ones, on compacted soil",
    .reference = "[Wong 2010, repetitive loading]; ARTEMIS section 2.3 names it as open work",
    .fields = kFields,
    .on_soil = &change};

}  // namespace slipway::sim
