#include "sim/effects/soft_patch.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

namespace slipway::sim {
namespace {

constexpr std::array kFields{
    Field{"x_m", "m", "map coordinate of the centre, eastward", -1.0e9, 1.0e9, 0.0},
    Field{"y_m", "m", "map coordinate of the centre, northward", -1.0e9, 1.0e9, 0.0},
    Field{"radius_m", "m", "radius of the patch", 0.0, 1000.0, 2.0, 0.0},
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

EffectVariant variant_at(const Disc& disc) {
  return {.label = fmt::format("{:.1f} m around ({:.1f}, {:.1f})", disc.radius_m, disc.x_m, disc.y_m),
          .free = {free_field(kFields, "weakening", 0.3)},
          .fixed = {{"x_m", disc.x_m}, {"y_m", disc.y_m}, {"radius_m", disc.radius_m}}};
}

// The benchmark chooses the place by its drives.
EffectParameters hidden(const HiddenDraw& draw) {
  return {{"weakening", draw.size < 1.0   ? 0.2
                        : draw.size < 2.0 ? 0.4
                                          : 0.6},
          {"radius_m", draw.between(2.0, 3.2, 0)}};
}

}  // namespace

constexpr Effect kSoftPatch{.name = "soft_patch",
                            .summary = "in one round place the soil is weaker than the map says",
                            .reference = "ARTEMIS section 1: Spirit at Troy, Opportunity in ripples",
                            .fields = kFields,
                            .on_soil = &change,
                            .region = &place,
                            .variants = &no_variants,
                            .variant_at = &variant_at,
                            .has_many_forms = true,
                            .hidden = &hidden};

}  // namespace slipway::sim
