#include "sim/effects/soil_gravity.h"

#include <array>

namespace slipway::sim {
namespace {

constexpr std::array kFields{
    Field{"exponent", "1", "a in k ~ (g / g0)^a", -1.0, 1.0, 1.0, 0.0},
    Field{"measured_at_m_s2", "m/s^2", "g0: gravity under which the soil was measured", 0.5, 25.0, 9.81},
};

void change(std::span<const double> values, Soil& soil) {
  soil.gravity_exponent = values[0];
  soil.measured_gravity_m_s2 = values[1];
}

}  // namespace

// Drives of one place can't distinguish it from the stiffness of their soil: it has no hypothesis, and no
// benchmark hides it.
constexpr Effect kSoilGravity{.name = "soil_gravity",
                              .summary = "the soil's stiffness scales with gravity",
                              .reference = "[Wong 2012]; [Kobayashi et al. 2010]",
                              .fields = kFields,
                              .on_soil = &change,
                              .variants = &no_variants};

}  // namespace slipway::sim
