#include "sim/effects/side_bulldozing.h"

#include <array>

namespace slipway::sim {
namespace {

constexpr std::array kFields{
    Field{"share", "1", "share of the soil's bearing capacity that acts on the side wall", 0.0, 5.0, 1.0,
          0.0},
};

void change(std::span<const double> values, Soil& soil) {
  soil.side_bulldozing = values[0];
}

EffectParameters hidden(const HiddenDraw& draw) {
  return {{"share", draw.size}};
}

}  // namespace

constexpr Effect kSideBulldozing{
    .name = "side_bulldozing",
    .summary = "the soil that a wheel's side wall pushes aside resists its side slip",
    .reference = "ARTEMIS eq. 12 to 14, 19",
    .fields = kFields,
    .on_soil = &change,
    .has_many_forms = true,
    .hidden = &hidden};

}  // namespace slipway::sim
