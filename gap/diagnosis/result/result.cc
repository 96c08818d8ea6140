#include "gap/diagnosis/result/result.h"

#include <algorithm>
#include <array>

namespace slipway::gap {
namespace {

// In the order of NuisanceKind.
constexpr std::array<std::string_view, 4> kMeasurements{
    "plate and shear tests of the soil",
    "tests of a single wheel on this soil, and the rover weighed (centre of mass, wheels)",
    "a wheel spun in the air, with its current", "surveyed positions, headings and sinkages"};

}  // namespace

std::string_view measurement_of(NuisanceKind kind) {
  return kMeasurements[static_cast<std::size_t>(kind)];
}

EffectMarginal marginal_of(std::span<const EffectMarginal> marginals, const std::string& effect) {
  const auto own = std::find_if(marginals.begin(), marginals.end(),
                                [&](const EffectMarginal& m) { return m.name == effect; });
  return own != marginals.end() ? *own : EffectMarginal{.name = effect};
}

std::vector<std::string> names_of(const ComparedSet& set) {
  std::vector<std::string> names = set.effects;
  if (set.with_unknown) names.emplace_back("unknown");
  return names;
}

}  // namespace slipway::gap
