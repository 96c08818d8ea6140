#include "sim/effects/effect.h"

#include <algorithm>
#include <cmath>

#include "core/random.h"

namespace slipway::sim {

double HiddenDraw::sign(std::uint64_t counter) const {
  return random_bits(key, counter) % 2 == 0 ? 1.0 : -1.0;
}

double HiddenDraw::between(double lowest, double highest, std::uint64_t counter) const {
  return lowest + 0.01 * (highest - lowest) * static_cast<double>(random_bits(key, counter) % 101);
}

std::vector<EffectVariant> no_variants(const RoverModel& /*rover*/) {
  return {};
}

EffectVariant variant_of_fields(const Effect& effect) {
  EffectVariant variant;
  for (const Field& field : effect.fields) {
    if (!field.neutral) continue;
    double std = std::abs(field.initial - *field.neutral);
    // A field that is neutral initially is as uncertain as the others of its unit.
    for (const Field& other : effect.fields)
      if (std == 0.0 && other.neutral && other.unit == field.unit)
        std = std::abs(other.initial - *other.neutral);
    variant.free.push_back(
        free_field(effect.fields, field.name, std > 0.0 ? std : 0.1 * (field.highest - field.lowest)));
  }
  return variant;
}

EffectVariant::Free free_field(std::span<const Field> fields, std::string_view name, double std) {
  const auto field =
      std::find_if(fields.begin(), fields.end(), [name](const Field& f) { return f.name == name; });
  return {std::string(name), std, field->lowest, field->highest};
}

}  // namespace slipway::sim
