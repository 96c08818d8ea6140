#include "research/benchmark/hidden_effect.h"

#include <string>

#include "sim/effects/effect_catalogue.h"

namespace slipway::campaign {

std::vector<std::string_view> hidden_effects() {
  std::vector<std::string_view> names;
  for (const sim::Effect& effect : sim::effect_catalogue())
    if (effect.hidden != nullptr) names.push_back(effect.name);
  return names;
}

sim::EffectSetting hidden_effect(std::string_view name, double size, std::uint64_t key,
                                 const sim::RoverModel& rover) {
  return {std::string(name), sim::find_effect(name)->hidden({size, key, rover})};
}

}  // namespace slipway::campaign
