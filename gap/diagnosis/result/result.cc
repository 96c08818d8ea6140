#include "gap/diagnosis/result/result.h"

#include <array>

namespace slipway::gap {
namespace {

constexpr std::array<std::string_view, 7> kVerdicts{"no_gap",     "not_detected", "parameters",  "effects",
                                                    "effect_set", "unknown",      "insufficient"};
// In the order of NuisanceKind.
constexpr std::array<std::string_view, 4> kMeasurements{
    "plate and shear tests of the soil",
    "tests of a single wheel on this soil, and the rover weighed (centre of mass, wheels)",
    "a wheel spun in the air, with its current", "surveyed positions, headings and sinkages"};

}  // namespace

std::string_view name_of(Verdict verdict) {
  return kVerdicts[static_cast<std::size_t>(verdict)];
}

std::string_view measurement_of(NuisanceKind kind) {
  return kMeasurements[static_cast<std::size_t>(kind)];
}

std::vector<std::string> names_of(const ComparedSet& set) {
  std::vector<std::string> names = set.effects;
  if (set.with_unknown) names.emplace_back("unknown");
  return names;
}

}  // namespace slipway::gap
