#include "sim/effects/side_bulldozing.h"

#include <array>

namespace slipway::sim {
namespace {

constexpr std::array kFields{
    Field{"share", "1", "share of the bearing capacity on the side wall", 0.0, 5.0, 1.0, 0.0},
};

void change(std::span<const double> values, Soil& soil) {
  soil.side_bulldozing = values[0];
}

}  // namespace

constexpr Effect kSideBulldozing{.name = "side_bulldozing",
                                 .summary = "soil pushed aside by a wheel's side wall resists side slip",
                                 .reference = "ARTEMIS eq. 12 to 14, 19",
                                 .fields = kFields,
                                 .on_soil = &change};

}  // namespace slipway::sim
