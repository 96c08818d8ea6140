#include "sim/effects/smooth_rim.h"

#include <array>

namespace slipway::sim {
namespace {

constexpr std::array kFields{
    Field{"friction_share", "1", "share of the soil's shear strength that the rim passes on", 0.2, 1.0, 0.8,
          1.0},
};

void change(std::span<const double> values, RoverModel& rover) {
  for (WheelModel& wheel : rover.wheels) wheel.rim_friction *= values[0];
}

}  // namespace

// Drives of one place can't distinguish it from the strength of their soil: it has no hypothesis, and no
// benchmark hides it.
constexpr Effect kSmoothRim{.name = "smooth_rim",
                            .summary = "a smooth rim slides on the soil before the soil shears",
                            .reference = "[Ding et al. 2011]: a smooth and a lugged wheel on one sand",
                            .fields = kFields,
                            .on_rover = &change,
                            .variants = &no_variants};

}  // namespace slipway::sim
