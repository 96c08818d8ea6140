#include "sim/effects/grousers.h"

#include <array>

namespace slipway::sim {
namespace {

constexpr std::array kFields{
    Field{"height_m", "m", "height of a grouser", 0.0, 0.05, 0.01, 0.0},
    Field{"count", "1", "grousers around a rim", 0.0, 100.0, 24.0, 0.0},
    Field{"mobilisation", "1", "shear displacement that mobilises a grouser's thrust, over the soil's own",
          0.02, 1.0, 1.0, 1.0},
    Field{"by_slip", "1",
          "share of a grouser's shear displacement that follows from slip alone instead of the rim's path",
          0.0, 1.0, 0.0, 0.0},
};

void change(std::span<const double> values, RoverModel& rover) {
  for (WheelModel& wheel : rover.wheels)
    wheel.grousers = Grousers{values[0], values[1], values[2], values[3]};
}

bool same(const std::optional<Grousers>& a, const std::optional<Grousers>& b) {
  if (!a || !b) return a.has_value() == b.has_value();
  return a->height_m == b->height_m && a->count == b->count && a->mobilisation == b->mobilisation &&
         a->by_slip == b->by_slip;
}

// Grousers that the rover file gives are where the estimate starts from. Wheels that differ in them are not
// asked: one height would not describe them.
std::vector<EffectVariant> variants(const RoverModel& rover) {
  const std::optional<Grousers>& own = rover.wheels.front().grousers;
  for (const WheelModel& wheel : rover.wheels)
    if (!same(wheel.grousers, own)) return {};
  EffectVariant::Free height = free_field(kFields, "height_m", 0.01);
  EffectVariant::Free mobilisation = free_field(kFields, "mobilisation", 0.5);
  if (own) {
    height.neutral = own->height_m;
    mobilisation.neutral = own->mobilisation;
    return {{.label = "of another height",
             .free = {height, mobilisation},
             .fixed = {{"count", own->count}, {"by_slip", own->by_slip}}}};
  }
  // The neutral count, none, would leave nothing to estimate.
  return {{.label = "mobilised along the rim",
           .free = {height, mobilisation},
           .fixed = {{"by_slip", 0.0}},
           .at_initial = {"count"}},
          {.label = "mobilised by slip",
           .free = {height, mobilisation},
           .fixed = {{"by_slip", 1.0}},
           .at_initial = {"count"}}};
}

EffectParameters hidden(const HiddenDraw& draw) {
  return {{"height_m", 0.01 * draw.size}, {"count", 24.0}};
}

}  // namespace

constexpr Effect kGrousers{.name = "grousers",
                           .summary = "grousers on the wheel rims push against the soil",
                           .reference = "ARTEMIS eq. 15, 18, 20",
                           .fields = kFields,
                           .on_rover = &change,
                           .variants = &variants,
                           .has_many_forms = true,
                           .hidden = &hidden};

}  // namespace slipway::sim
