#include "sim/effects/slip_sinkage.h"

#include <array>

namespace slipway::sim {
namespace {

constexpr std::array kFields{
    Field{"n1", "1", "rise of the sinkage exponent from no slip to full slip", 0.0, 1.5, 0.3, 0.0},
    Field{"n1_skid", "1", "further rise from rolling to a locked wheel", 0.0, 1.5, 0.0, 0.0},
    Field{"n1_lateral", "1", "further rise from straight to sideways motion", 0.0, 1.5, 0.0, 0.0},
};

void change(std::span<const double> values, Soil& soil) {
  soil.n1 = values[0];
  soil.n1_skid = values[1];
  soil.n1_lateral = values[2];
}

}  // namespace

constexpr Effect kSlipSinkage{.name = "slip_sinkage",
                              .summary = "a slipping wheel digs itself in: n = n0 + n1 |i|",
                              .reference = "[Ding et al. 2010]; ARTEMIS eq. 22",
                              .fields = kFields,
                              .on_soil = &change};

}  // namespace slipway::sim
