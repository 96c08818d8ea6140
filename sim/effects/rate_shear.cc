#include "sim/effects/rate_shear.h"

#include <array>

namespace slipway::sim {
namespace {

constexpr std::array kFields{
    Field{"exponent", "1", "a in K = K0 (v / v0)^a", -1.0, 1.0, 0.3, 0.0},
    Field{"speed_m_s", "m/s", "v0: the rim speed at which the soil's modulus was measured", 0.001, 1.0, 0.04},
};

void change(std::span<const double> values, Soil& soil) {
  soil.rate_shear_exponent = values[0];
  soil.rate_shear_speed_m_s = values[1];
}

std::vector<EffectVariant> variants(const RoverModel& /*rover*/) {
  return {{.free = {free_field(kFields, "exponent", 0.3)}}};
}

EffectParameters hidden(const HiddenDraw& draw) {
  return {{"exponent", 0.3 * draw.size}};
}

}  // namespace

constexpr Effect kRateShear{
    .name = "rate_shear",
    .summary = "the soil's shear modulus changes with the speed of the wheel's rim",
    .reference = "Zhurong section 5 names it as open work; a power law as for rate effects in sand",
    .fields = kFields,
    .on_soil = &change,
    .variants = &variants,
    .hidden = &hidden};

}  // namespace slipway::sim
