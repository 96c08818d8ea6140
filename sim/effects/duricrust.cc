#include "sim/effects/duricrust.h"

#include <fmt/format.h>

#include <array>

namespace slipway::sim {
namespace {

constexpr std::array kFields{
    Field{"strength_pa", "Pa", "greatest pressure that the crust adds to the loose soil's", 0.0, 100000.0,
          5000.0, 0.0},
    Field{"depth_m", "m", "sinkage at which the crust breaks", 0.001, 0.1, 0.005},
};

void change(std::span<const double> values, Soil& soil) {
  soil.crust = {values[0], values[1]};
}

// What a crust does is not smooth in its depth: depths are tried one by one.
std::vector<EffectVariant> variants(const RoverModel& /*rover*/) {
  std::vector<EffectVariant> all;
  for (const double depth_m : {0.003, 0.006, 0.012, 0.025})
    all.push_back({.label = fmt::format("breaking at {:g} mm", 1e3 * depth_m),
                   .free = {free_field(kFields, "strength_pa", 5000.0)},
                   .fixed = {{"depth_m", depth_m}}});
  return all;
}

EffectParameters hidden(const HiddenDraw& draw) {
  return {{"strength_pa", 5000.0 * draw.size}, {"depth_m", 0.005}};
}

}  // namespace

constexpr Effect kDuricrust{
    .name = "duricrust",
    .summary = "a crust on loose soil carries the wheel until it breaks",
    .reference = "ARTEMIS section 1: Spirit broke through a crust at Troy; Zhurong section 1",
    .fields = kFields,
    .on_soil = &change,
    .variants = &variants,
    .has_many_forms = true,
    .hidden = &hidden};

}  // namespace slipway::sim
