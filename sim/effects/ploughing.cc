#include "sim/effects/ploughing.h"

#include <array>

namespace slipway::sim {
namespace {

constexpr std::array kFields{
    Field{"front", "1", "factor of passive earth pressure before the front, added to the soil's own", 0.0,
          60.0, 8.5, 0.0},
    Field{"wall", "1", "factor of passive earth pressure before the side wall, added likewise", 0.0, 60.0,
          12.0, 0.0},
    Field{"heap", "1", "what the heap before a locked wheel adds, as a share", 0.0, 10.0, 1.7},
    Field{"heap_slip", "1", "rim's way over the wheel's at which that is down to 1 / e", 0.01, 20.0, 1.8},
    Field{"wall_friction", "1", "coefficient of friction of soil on the wall", 0.0, 1.5, 0.43},
    Field{"wall_turn", "1", "speed of the wall along its plane over the rim's", 0.0, 1.0, 0.15},
    Field{"wall_yield", "1", "how far sideways speed turns the wall's friction away", 0.0, 10.0, 1.1},
};

void change(std::span<const double> values, Soil& soil) {
  if (values[0] == 0.0 && values[1] == 0.0) return;
  soil.ploughing = {.front = soil.ploughing.front + values[0],
                    .wall = soil.ploughing.wall + values[1],
                    .heap = values[2],
                    .heap_slip = values[3],
                    .wall_friction = values[4],
                    .wall_turn = values[5],
                    .wall_yield = values[6]};
}

}  // namespace

// Drives of one place can't distinguish it from the parameters of their soil: it has no hypothesis, and no
// benchmark hides it.
constexpr Effect kPloughing{
    .name = "ploughing",
    .summary = "a wheel pushes soil before its front and its wall, also deeper than its axle",
    .reference = "passive earth pressure [McKyes & Ali 1977]; heap and wall from [Pavlov & Johnson 2022]",
    .fields = kFields,
    .on_soil = &change,
    .variants = &no_variants};

}  // namespace slipway::sim
