#include "sim/effects/bulldozing.h"

#include <array>

namespace slipway::sim {
namespace {

constexpr std::array kFields{
    Field{"share", "1", "share of the passive earth pressure that acts on the wheel's front", 0.0, 5.0, 1.0,
          0.0},
    Field{"in_tracks", "1", "share of that resistance which a wheel in another wheel's track still meets",
          0.0, 1.0, 0.0, 0.0},
};

void change(std::span<const double> values, Soil& soil) {
  soil.bulldozing = values[0];
  soil.track_bulldozing = values[1];
}

std::vector<EffectVariant> variants(const RoverModel& /*rover*/) {
  const EffectVariant::Free share = free_field(kFields, "share", 1.0);
  return {{.label = "before wheels on fresh ground", .free = {share}, .fixed = {{"in_tracks", 0.0}}},
          {.label = "before every wheel", .free = {share}, .fixed = {{"in_tracks", 1.0}}}};
}

EffectParameters hidden(const HiddenDraw& draw) {
  return {{"share", draw.size}};
}

}  // namespace

constexpr Effect kBulldozing{
    .name = "bulldozing",
    .summary = "the soil that is heaped up in front of a wheel resists it",
    .reference = "[Terzaghi 1943]; ARTEMIS leaves the front out, Zhurong section 3.1 names it",
    .fields = kFields,
    .on_soil = &change,
    .twin = "plough_front",
    .variants = &variants,
    .has_many_forms = true,
    .hidden = &hidden};

}  // namespace slipway::sim
