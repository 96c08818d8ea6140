#include "sim/effects/bulldozing.h"

#include <array>

namespace slipway::sim {
namespace {

constexpr std::array kFields{
    Field{"share", "1", "share of the passive earth pressure on the front", 0.0, 5.0, 1.0, 0.0},
    Field{"in_tracks", "1", "share of that which a wheel in another's track still meets", 0.0, 1.0, 0.0, 0.0},
};

void change(std::span<const double> values, Soil& soil) {
  soil.bulldozing = values[0];
  soil.track_bulldozing = values[1];
}

}  // namespace

constexpr Effect kBulldozing{
    .name = "bulldozing",
    .summary = "soil heaped up before a wheel resists it",
    .reference = "[Terzaghi 1943]; ARTEMIS leaves the front out, Zhurong section 3.1 names it",
    .fields = kFields,
    .on_soil = &change};

}  // namespace slipway::sim
