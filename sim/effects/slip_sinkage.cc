#include "sim/effects/slip_sinkage.h"

#include <array>

namespace slipway::sim {
namespace {

constexpr std::array kFields{
    Field{"n1", "1", "rise of the sinkage exponent from no slip to full slip", 0.0, 1.5, 0.3, 0.0},
};

void change(std::span<const double> values, Soil& soil) {
  soil.n1 = values[0];
}

}  // namespace

constexpr Effect kSlipSinkage{.name = "slip_sinkage",
                              .summary = "a slipping wheel digs itself in: n = n0 + n1 |i|",
                              .reference = "[Ding et al. 2010]; ARTEMIS eq. 22",
                              .fields = kFields,
                              .on_soil = &change};

}  // namespace slipway::sim
