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
    Field{"shear_share", "1", "where the soil is sheared, from the rim (0) to the grousers' tips (1)", 0.0,
          1.0, 0.0, 0.0},
    Field{"surcharge", "1", "share of the rim's pressure that presses on the soil before a grouser", 0.0, 1.0,
          0.0, 0.0},
};

void change(std::span<const double> values, RoverModel& rover) {
  for (WheelModel& wheel : rover.wheels) {
    Grousers own = wheel.grousers.value_or(Grousers{});
    own.height_m = values[0];
    own.count = values[1];
    own.mobilisation = values[2];
    own.by_slip = values[3];
    own.shear_share = values[4];
    own.surcharge = values[5];
    wheel.grousers = own;
  }
}

bool same(const std::optional<Grousers>& a, const std::optional<Grousers>& b) {
  if (!a || !b) return a.has_value() == b.has_value();
  return a->height_m == b->height_m && a->count == b->count && a->mobilisation == b->mobilisation &&
         a->by_slip == b->by_slip && a->shear_share == b->shear_share && a->surcharge == b->surcharge;
}

// Grousers that the rover file gives are where the estimate starts from. Wheels that differ in them are not
// asked: one height would not describe them.
std::vector<EffectVariant> variants(const RoverModel& rover) {
  const std::optional<Grousers>& own = rover.wheels.front().grousers;
  for (const WheelModel& wheel : rover.wheels)
    if (!same(wheel.grousers, own)) return {};
  EffectVariant::Free height = free_field(kFields, "height_m", 0.01);
  EffectVariant::Free mobilisation = free_field(kFields, "mobilisation", 0.5);
  // Soil between grousers is sheared a little beyond the rim, so that the rover gets farther, as on larger
  // wheels. A little: what goes far beyond is a larger wheel (the effect wheel_radius) rather than this.
  EffectVariant::Free share = free_field(kFields, "shear_share", 0.05);
  EffectVariant::Free surcharge = free_field(kFields, "surcharge", 0.2);
  mobilisation.shape = share.shape = surcharge.shape = true;
  if (own) {
    height.neutral = own->height_m;
    mobilisation.neutral = own->mobilisation;
    share.neutral = own->shear_share;
    surcharge.neutral = own->surcharge;
    return {{.label = "of another height",
             .free = {height, mobilisation, share, surcharge},
             .fixed = {{"count", own->count}, {"by_slip", own->by_slip}}}};
  }
  // The neutral count, none, would leave nothing to estimate.
  return {{.label = "mobilised along the rim",
           .free = {height, mobilisation, share, surcharge},
           .fixed = {{"by_slip", 0.0}},
           .at_initial = {"count"}},
          {.label = "mobilised by slip",
           .free = {height, mobilisation, share, surcharge},
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
