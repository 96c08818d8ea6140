#include "sim/effects/hardpan.h"

#include <fmt/format.h>

#include <array>

namespace slipway::sim {
namespace {

constexpr std::array kFields{
    Field{"depth_m", "m", "depth of the layer under the surface", 0.0, 0.5, 0.01},
    Field{"modulus_pa_m", "Pa/m", "pressure that the layer adds per metre of sinkage into it", 0.0, 1.0e8,
          1.0e6, 0.0},
};

void change(std::span<const double> values, Soil& soil) {
  soil.hardpan = {values[1], values[0]};
}

// What a layer does is not smooth in its depth: depths are tried one by one.
std::vector<EffectVariant> variants(const RoverModel& /*rover*/) {
  std::vector<EffectVariant> all;
  for (const double depth_m : {0.005, 0.01, 0.015, 0.02, 0.03})
    all.push_back({.label = fmt::format("at {:g} mm", 1e3 * depth_m),
                   .free = {free_field(kFields, "modulus_pa_m", 2e6)},
                   .fixed = {{"depth_m", depth_m}}});
  return all;
}

EffectParameters hidden(const HiddenDraw& draw) {
  return {{"modulus_pa_m", 1e6 * draw.size}, {"depth_m", draw.between(0.006, 0.010, 0)}};
}

}  // namespace

constexpr Effect kHardpan{.name = "hardpan",
                          .summary = "a stiff layer lies under the loose soil",
                          .reference = "ROAMS section 4: paving stones under sand; [Wong 2010]",
                          .fields = kFields,
                          .on_soil = &change,
                          .variants = &variants,
                          .has_many_forms = true,
                          .hidden = &hidden};

}  // namespace slipway::sim
