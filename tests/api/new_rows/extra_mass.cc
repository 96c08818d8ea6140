#include "tests/api/new_rows/extra_mass.h"

#include <array>

namespace slipway::sim {
namespace {

constexpr std::array kFields{
    Field{"mass_kg", "kg", "mass that the rover carries at its centre of mass", 0.0, 200.0, 20.0, 0.0},
};

void change(std::span<const double> values, RoverModel& rover) {
  rover.mass_kg += values[0];
}

EffectParameters hidden(const HiddenDraw& draw) {
  return {{"mass_kg", 20.0 * draw.size}};
}

}  // namespace

constexpr Effect kExtraMass{.name = "extra_mass",
                            .summary = "the rover carries more than its file says",
                            .reference = "a test",
                            .fields = kFields,
                            .on_rover = &change,
                            .hidden = &hidden};

}  // namespace slipway::sim
