#include "sim/effects/com_offset.h"

#include <array>

namespace slipway::sim {
namespace {

constexpr std::array kFields{
    Field{"x_m", "m", "shift of the centre of mass forward", -0.5, 0.5, -0.05, 0.0},
    Field{"y_m", "m", "shift of the centre of mass to the left", -0.5, 0.5, 0.0, 0.0},
    Field{"z_m", "m", "shift of the centre of mass upward", -0.5, 0.5, 0.0, 0.0},
};

void change(std::span<const double> values, RoverModel& rover) {
  rover.com_m += Eigen::Vector3d(values[0], values[1], values[2]);
}

// The height is re-tuned in every hypothesis: by it other laws of pulls and ruts show.
std::vector<EffectVariant> variants(const RoverModel& /*rover*/) {
  return {{.free = {free_field(kFields, "x_m", 0.05), free_field(kFields, "y_m", 0.05)}}};
}

EffectParameters hidden(const HiddenDraw& draw) {
  return {{"x_m", draw.sign(0) * 0.06 * draw.size}, {"y_m", draw.sign(1) * 0.03 * draw.size}};
}

}  // namespace

constexpr Effect kComOffset{.name = "com_offset",
                            .summary = "the centre of mass does not lie where the rover file has it",
                            .reference = "Zhurong section 4.1: random shifts of the centroid",
                            .fields = kFields,
                            .on_rover = &change,
                            .variants = &variants,
                            .hidden = &hidden};

}  // namespace slipway::sim
