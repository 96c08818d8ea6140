#include "sim/effects/slip_sinkage.h"

#include <array>

namespace slipway::sim {
namespace {

constexpr std::array kFields{
    Field{"n1", "1", "rise of the sinkage exponent from no slip to full slip, added to the soil's own", 0.0,
          1.5, 0.3, 0.0},
    Field{"n1_skid", "1", "further rise from rolling to a locked wheel, added likewise", 0.0, 1.5, 0.0, 0.0},
    Field{"n1_lateral", "1", "further rise from straight to sideways motion, added likewise", 0.0, 1.5, 0.0,
          0.0},
};

// Added to what the soil has already: with neutral numbers every soil stays what it is.
void change(std::span<const double> values, Soil& soil) {
  soil.n1 += values[0];
  soil.n1_skid += values[1];
  soil.n1_lateral += values[2];
}

std::vector<EffectVariant> variants(const RoverModel& /*rover*/) {
  return {{.free = {free_field(kFields, "n1", 0.3)}}};
}

EffectParameters hidden(const HiddenDraw& draw) {
  return {{"n1", 0.3 * draw.size}};
}

}  // namespace

constexpr Effect kSlipSinkage{
    .name = "slip_sinkage",
    .summary = "a slipping wheel digs itself in: the sinkage exponent rises by n1 |slip|",
    .reference = "[Ding et al. 2010]; ARTEMIS eq. 22",
    .fields = kFields,
    .on_soil = &change,
    .variants = &variants,
    .has_many_forms = true,
    .hidden = &hidden};

}  // namespace slipway::sim
