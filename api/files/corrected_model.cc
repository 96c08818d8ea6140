#include "api/files/corrected_model.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>

#include "api/files/rover_file.h"
#include "api/files/soil_file.h"
#include "api/json/writer.h"
#include "core/digest.h"
#include "gap/diagnosis/model/nuisance_catalogue.h"
#include "sim/effects/effect_catalogue.h"

namespace slipway::api {
namespace {

constexpr std::size_t kMaxName = 28;  // of each part; a whole name has 64 at most
constexpr std::size_t kMaxSummary = 480;

// Made of what a catalogue's name may have.
std::string as_name(std::string_view text) {
  std::string name;
  for (const char c : text.substr(0, kMaxName)) {
    const bool lower = (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
    const bool upper = c >= 'A' && c <= 'Z';
    name += lower ? c : upper ? static_cast<char>(c - 'A' + 'a') : '-';
  }
  return name.empty() ? "unnamed" : name;
}

// The parameter that the nuisance is for this soil ("friction/sand", or "friction" where there is one soil).
const gap::RetunedParameter* retuned(const gap::Diagnosis& diagnosis, std::string_view nuisance,
                                     const std::string& soil) {
  const auto found =
      std::find_if(diagnosis.retuned.begin(), diagnosis.retuned.end(),
                   [&](const gap::RetunedParameter& p) { return gap::is_nuisance(p.name, nuisance, soil); });
  return found == diagnosis.retuned.end() ? nullptr : &*found;
}

sim::SoilDistribution soil_of(const gap::NominalSoil& nominal, const gap::Diagnosis& diagnosis) {
  sim::SoilDistribution soil;
  soil.name = nominal.name;
  soil.mean = nominal.soil;
  for (const gap::Nuisance& row : gap::nuisance_catalogue())
    if (const auto* const p = retuned(diagnosis, row.name, nominal.name);
        p != nullptr && row.on_soil != nullptr)
      row.on_soil(p->value.value, soil.mean);
  gap::set_spread(diagnosis.left_open, diagnosis.noise, soil);
  soil.assumed = {"correlation_length_m"};
  return soil;
}

std::string version_of(const CorrectedModel& model) {
  json::Writer w;
  json::write_rover(w, model.rover);
  for (const sim::SoilDistribution& soil : model.soils) json::write_soil(w, soil);
  return fmt::format("{:016x}", fnv1a(w.take())).substr(0, 6);
}

}  // namespace

std::optional<CorrectedModel> corrected_model(const gap::DriveCampaign& campaign,
                                              const gap::Diagnosis& diagnosis) {
  if (!diagnosis.model) return std::nullopt;
  CorrectedModel model;
  model.effects = diagnosis.model->effects;
  model.noise = diagnosis.noise;
  model.left_open = diagnosis.left_open;
  sim::RoverModel& rover = model.rover;
  rover = *diagnosis.nominal_rover;
  for (const gap::Nuisance& row : gap::nuisance_catalogue())
    if (const auto* const p = retuned(diagnosis, row.name, ""); p != nullptr && row.on_rover != nullptr)
      row.on_rover(p->value.value, rover);
  rover.effects.clear();
  for (const sim::EffectSetting& setting : model.effects)
    if (const sim::Effect* const effect = sim::find_effect(setting.name);
        effect != nullptr && effect->region == nullptr)
      rover.effects.push_back(setting);
  for (const gap::NominalSoil& nominal : diagnosis.nominal_soils)
    model.soils.push_back(soil_of(nominal, diagnosis));

  std::vector<std::string> names;
  for (const sim::EffectSetting& setting : model.effects) names.push_back(setting.name);
  const std::string source =
      fmt::format("re-tuned to the drives of campaign {} (fingerprint {}) by a diagnosis with seed {}",
                  as_name(campaign.name), campaign.fingerprint, diagnosis.seed);
  rover.summary =
      fmt::format("{} as campaign {} shows it: {}", as_name(rover.name), as_name(campaign.name),
                  names.empty() ? "no effect is missing" : fmt::format("{}", fmt::join(names, ", ")))
          .substr(0, kMaxSummary);
  rover.sources = {source};
  const std::string version = version_of(model);
  const auto versioned = [&](const std::string& name) {
    return fmt::format("{}-{}-{}", as_name(name), as_name(campaign.name), version);
  };
  rover.name = versioned(rover.name);
  for (sim::SoilDistribution& soil : model.soils) {
    soil.summary = fmt::format("{} as campaign {} shows it", as_name(soil.name), as_name(campaign.name));
    soil.source = source;
    soil.name = versioned(soil.name);
  }
  return model;
}

}  // namespace slipway::api
