#include "sim/effects/soft_patch.h"

#include <array>
#include <cmath>

namespace slipway::sim {
namespace {

constexpr std::array kFields{
    Field{"x_m", "m", "east of the centre, map frame", -1.0e9, 1.0e9, 0.0},
    Field{"y_m", "m", "north of the centre, map frame", -1.0e9, 1.0e9, 0.0},
    Field{"radius_m", "m", "radius of the place", 0.0, 1000.0, 2.0, 0.0},
    Field{"weakening", "1", "share of stiffness, cohesion and friction that is missing", 0.0, 0.95, 0.4, 0.0},
};

void change(std::span<const double> values, Soil& soil) {
  const double left = 1.0 - values[3];
  soil.stiffen(left);
  soil.cohesion_pa *= left;
  if (left < 1.0) soil.friction_angle_rad = std::atan(left * std::tan(soil.friction_angle_rad));
}

Disc place(std::span<const double> values) {
  return {values[0], values[1], values[2]};
}

}  // namespace

constexpr Effect kSoftPatch{.name = "soft_patch",
                            .summary = "a place with weaker soil than the map says",
                            .reference = "ARTEMIS section 1: Spirit at Troy, Opportunity in ripples",
                            .fields = kFields,
                            .on_soil = &change,
                            .region = &place};

}  // namespace slipway::sim
