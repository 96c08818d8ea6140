#include "sim/effects/cleat_shear_radius.h"

#include <algorithm>
#include <array>

namespace slipway::sim {
namespace {

constexpr std::array kFields{
    Field{"share", "1", "where the soil is sheared, from the rim (0) to the cleats' tips (1)", 0.0, 1.0, 0.0,
          0.0},
    Field{"by_spacing", "1", "how much of the share that height, spacing and friction angle give is added",
          0.0, 1.0, 1.0, 0.0},
    Field{"thrust", "1", "share of the cleats' passive thrust that is left besides", 0.0, 1.0, 0.0, 1.0},
    Field{"braking", "1", "share of that thrust that brakes in skid", 0.0, 1.0, 0.0, 1.0},
    Field{"height_m", "m", "height of a cleat; 0: the wheel's own grousers", 0.0, 0.05, 0.0, 0.0},
    Field{"count", "1", "cleats around a rim, where height_m is given", 0.0, 100.0, 24.0, 0.0},
};

// Of the wheel's own grousers (the rover's file, --grousers or the effect grousers, which comes first).
void change(std::span<const double> values, RoverModel& rover) {
  for (WheelModel& wheel : rover.wheels) {
    if (values[4] > 0.0) wheel.grousers = Grousers{values[4], values[5]};
    if (!wheel.grousers) continue;
    Grousers& cleats = *wheel.grousers;
    cleats.shear_share = std::min(1.0, cleats.shear_share + values[0]);
    cleats.shear_by_spacing = std::min(1.0, cleats.shear_by_spacing + values[1]);
    cleats.thrust *= values[2];
    cleats.braking *= values[3];
  }
}

}  // namespace

// Drives of one place can't distinguish it from a larger wheel: it has no hypothesis, and no benchmark hides
// it.
constexpr Effect kCleatShearRadius{
    .name = "cleat_shear_radius",
    .summary = "soil between tall, close cleats turns with the wheel and is sheared towards their tips",
    .reference = "[Ding et al. 2011]; share by Rankine's wedge before each cleat",
    .fields = kFields,
    .on_rover = &change,
    .variants = &no_variants};

}  // namespace slipway::sim
