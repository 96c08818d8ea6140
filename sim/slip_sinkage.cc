#include "sim/slip_sinkage.h"

#include <array>

namespace slipway::sim {
namespace {

constexpr std::array kFields{
    Field{"n1", "1", "rise of the sinkage exponent from no slip to full slip", 0.0, 1.0, 0.3},
};

void apply(std::span<const double> values, Soil& soil) {
  soil.n1 = values[0];
}

}  // namespace

constexpr Effect kSlipSinkage{
    "slip_sinkage", "a slipping wheel digs itself in", "[Ding et al. 2010]; ARTEMIS eq. 22", kFields, nullptr,
    &apply};

}  // namespace slipway::sim
