#include "sim/effects/multipass.h"

#include <array>

namespace slipway::sim {
namespace {

constexpr std::array kFields{
    Field{"stiffening", "1", "the soil in a track is 1 + this times as stiff as fresh soil", 0.0, 5.0, 0.9,
          0.0},
};

void change(std::span<const double> values, Soil& soil) {
  soil.multipass_stiffening = values[0];
}

std::vector<EffectVariant> variants(const RoverModel& /*rover*/) {
  return {{.free = {free_field(kFields, "stiffening", 0.4)}}};
}

EffectParameters hidden(const HiddenDraw& draw) {
  return {{"stiffening", 0.9 * draw.size}};
}

}  // namespace

constexpr Effect kMultipass{
    .name = "multipass",
    .summary = "wheels that follow in the tracks of others run on soil that those have compacted",
    .reference = "[Wong 2010, repetitive loading]; ARTEMIS section 2.3 names it as open work",
    .fields = kFields,
    .on_soil = &change,
    .variants = &variants,
    .has_many_forms = true,
    .hidden = &hidden};

}  // namespace slipway::sim
