#include "api/soil_beliefs.h"

namespace slipway::api {
namespace {

// The effects in force on a soil and on its alternatives, in their regions where it lies in some.
void apply(const std::vector<sim::EffectSetting>& effects, const std::vector<std::size_t>& regions,
           sim::SoilDistribution& belief) {
  sim::apply_effects(effects, belief.mean);
  for (const std::size_t region : regions) sim::apply_in_region(effects, region, belief.mean);
  for (sim::SoilAlternative& alternative : belief.alternatives) {
    sim::SoilDistribution changed = *alternative.soil;
    apply(effects, regions, changed);
    alternative.soil = std::make_shared<const sim::SoilDistribution>(std::move(changed));
  }
}

}  // namespace

sim::SoilDistribution believed(const Catalogue& catalogue, const RegionalSoil& soil, double confidence,
                               std::string_view unmapped, const std::vector<sim::EffectSetting>& effects) {
  sim::SoilDistribution belief = catalogue.soils.find(soil.base)->second;
  const sim::SoilDistribution& unknown = catalogue.soils.find(unmapped)->second;
  if (confidence < 1.0 && belief.name != unknown.name && belief.alternatives.empty() &&
      belief.mean.slip_curve == nullptr) {
    double pressure = 0.0, strength = 0.0;
    for (const sim::SoilAlternative& each : unknown.alternatives) {
      pressure += each.pressure_weight;
      strength += each.strength_weight;
    }
    belief.alternatives.push_back(
        {belief.name, std::make_shared<const sim::SoilDistribution>(belief), confidence, confidence});
    for (sim::SoilAlternative other : unknown.alternatives) {
      other.pressure_weight *= (1.0 - confidence) / pressure;
      other.strength_weight *= (1.0 - confidence) / strength;
      belief.alternatives.push_back(std::move(other));
    }
    belief.alternatives_by = sim::AlternativesBy::kUnit;
  }
  apply(effects, soil.regions, belief);
  if (!soil.regions.empty()) belief.name = soil.name();
  return belief;
}

}  // namespace slipway::api
