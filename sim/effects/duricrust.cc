#include "sim/effects/duricrust.h"

#include <array>

namespace slipway::sim {
namespace {

constexpr std::array kFields{
    Field{"strength_pa", "Pa", "greatest pressure that the crust adds", 0.0, 100000.0, 5000.0, 0.0},
    Field{"depth_m", "m", "sinkage at which it breaks", 0.001, 0.1, 0.005},
};

void change(std::span<const double> values, Soil& soil) {
  soil.crust = {values[0], values[1]};
}

}  // namespace

constexpr Effect kDuricrust{
    .name = "duricrust",
    .summary = "a crust on loose soil that carries until it breaks",
    .reference = "ARTEMIS section 1: Spirit broke through a crust at Troy; Zhurong section 1",
    .fields = kFields,
    .on_soil = &change};

}  // namespace slipway::sim
