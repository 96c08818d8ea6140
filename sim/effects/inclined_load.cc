#include "sim/effects/inclined_load.h"

#include <array>

namespace slipway::sim {
namespace {

constexpr std::array kFields{
    Field{"softening", "1",
          "logarithm of what a locked wheel takes from the pressure, added to the soil's own", 0.0, 6.0, 2.0,
          0.0},
};

void change(std::span<const double> values, Soil& soil) {
  soil.inclined_softening += values[0];
}

}  // namespace

// Drives of one place can't distinguish it from the parameters of their soil: it has no hypothesis, and no
// benchmark hides it.
constexpr Effect kInclinedLoad{
    .name = "inclined_load",
    .summary = "soil bears less under a wheel that skids or slides sideways, whose load is inclined",
    .reference = "[Meyerhof 1953]; [Hansen 1970]; by the motion, from [Pavlov & Johnson 2022]",
    .fields = kFields,
    .on_soil = &change,
    .variants = &no_variants};

}  // namespace slipway::sim
