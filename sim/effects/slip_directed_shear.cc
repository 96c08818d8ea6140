#include "sim/effects/slip_directed_shear.h"

#include <algorithm>
#include <array>

namespace slipway::sim {
namespace {

constexpr std::array kFields{
    Field{"share", "1", "0: shear against the displacement, 1: against the sliding of the rim", 0.0, 1.0, 1.0,
          0.0},
};

void change(std::span<const double> values, Soil& soil) {
  soil.slip_directed = std::max(soil.slip_directed, values[0]);
}

}  // namespace

// Drives of one place can't distinguish it from the parameters of their soil: it has no hypothesis, and no
// benchmark hides it.
constexpr Effect kSlipDirectedShear{
    .name = "slip_directed_shear",
    .summary = "the shear stress acts against the rim's sliding over the soil, along and across as one",
    .reference = "[Schwanghart 1968]; chosen on the tests of [Pavlov & Johnson 2022]",
    .fields = kFields,
    .on_soil = &change,
    .variants = &no_variants};

}  // namespace slipway::sim
