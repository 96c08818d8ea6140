#include "sim/effects/grousers.h"

#include <array>

namespace slipway::sim {
namespace {

constexpr std::array kFields{
    Field{"height_m", "m", "height of a grouser", 0.0, 0.05, 0.01, 0.0},
    Field{"count", "1", "grousers around a rim", 0.0, 100.0, 24.0, 0.0},
    Field{"mobilisation", "1", "shear that mobilises a grouser's thrust, over the soil's", 0.02, 1.0, 1.0,
          1.0},
    Field{"by_slip", "1", "share of a grouser's displacement that slip alone makes, not the rim's path", 0.0,
          1.0, 0.0, 0.0},
};

void change(std::span<const double> values, RoverModel& rover) {
  for (WheelModel& wheel : rover.wheels)
    wheel.grousers = Grousers{values[0], values[1], values[2], values[3]};
}

}  // namespace

constexpr Effect kGrousers{.name = "grousers",
                           .summary = "cleats on the rims push against the soil",
                           .reference = "ARTEMIS eq. 15, 18, 20",
                           .fields = kFields,
                           .on_rover = &change};

}  // namespace slipway::sim
