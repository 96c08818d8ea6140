#include "sim/effects/hardpan.h"

#include <array>

namespace slipway::sim {
namespace {

constexpr std::array kFields{
    Field{"depth_m", "m", "depth of the layer under the surface", 0.0, 0.5, 0.01},
    Field{"modulus_pa_m", "Pa/m", "modulus of the layer", 0.0, 1.0e8, 1.0e6, 0.0},
};

void change(std::span<const double> values, Soil& soil) {
  soil.hardpan = {values[1], values[0]};
}

}  // namespace

constexpr Effect kHardpan{.name = "hardpan",
                          .summary = "a stiff layer lies under the loose soil",
                          .reference = "ROAMS section 4: paving stones under sand; [Wong 2010]",
                          .fields = kFields,
                          .on_soil = &change};

}  // namespace slipway::sim
