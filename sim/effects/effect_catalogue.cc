#include "sim/effects/effect_catalogue.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "sim/soil/soil_field.h"

namespace slipway::sim {
namespace {

template <class Rows>
std::string names_of(const Rows& all) {
  std::string list;
  for (const auto& row : all) list += fmt::format("{}{}", list.empty() ? "" : ", ", row.name);
  return list;
}

void check_parameters(const Effect& effect, const EffectSetting& setting, std::size_t index,
                      std::vector<Fault>& faults) {
  for (const auto& [name, value] : setting.parameters) {
    const std::string pointer = fmt::format("/{}/parameters/{}", index, name);
    const auto field = std::find_if(effect.fields.begin(), effect.fields.end(),
                                    [&key = name](const Field& f) { return f.name == key; });
    if (field == effect.fields.end()) {
      faults.push_back({pointer, fmt::format("unknown parameter \"{}\" of {}, known are: {}", name,
                                             effect.name, names_of(effect.fields))});
    } else if (!(value >= field->lowest && value <= field->highest)) {
      faults.push_back({pointer, fmt::format("{} = {:g}, must be in [{:g}, {:g}]", name, value, field->lowest,
                                             field->highest)});
    }
  }
}

// Calls act(effect, values) for every row that is switched on, in the catalogue's order.
template <class Act>
void for_each_on(std::span<const EffectSetting> settings, const Act& act) {
  for (const Effect& effect : effect_catalogue()) {
    const auto is_this = [&](const EffectSetting& s) { return s.name == effect.name; };
    const auto setting = std::find_if(settings.begin(), settings.end(), is_this);
    if (setting == settings.end() || !setting->on) continue;
    act(effect, values_of(effect, *setting));
  }
}

// The optional field that a soil has already and that one number of the effect, the others neutral, changes
// in it and in a soil that has none; null where there is none.
const SoilField* field_of_its_own(const Effect& effect, std::size_t number, const Soil& soil) {
  std::vector<double> values;
  for (const Field& field : effect.fields) values.push_back(field.neutral.value_or(field.initial));
  values[number] = effect.fields[number].initial;
  Soil bare, changed, own = soil, both = soil;
  effect.on_soil(values, changed);
  effect.on_soil(values, both);
  for (const SoilField& field : soil_fields())
    if (field.presence == FieldPresence::kOptional && field.number(changed) != field.number(bare) &&
        field.number(own) != field.number(bare) && field.number(both) != field.number(own))
      return &field;
  return nullptr;
}

// The soil with all effects but one.
Soil with_others(std::span<const EffectSetting> settings, std::string_view but, Soil soil) {
  for_each_on(settings, [&](const Effect& effect, const std::vector<double>& values) {
    if (effect.name != but && effect.on_soil != nullptr && !effect.region) effect.on_soil(values, soil);
  });
  return soil;
}

// Where the soil has the effect's force by another equation, and nobody stated how much of the effect is
// meant.
std::optional<std::string> twin_fault(const Effect& effect, const EffectSetting& setting, Soil met,
                                      std::string_view soil_name) {
  const std::string stated(effect.fields.front().name);
  if (effect.twin.empty() || setting.parameters.contains(stated)) return std::nullopt;
  const std::span<const SoilField> fields = soil_fields();
  const auto twin = std::find_if(fields.begin(), fields.end(),
                                 [&](const SoilField& each) { return each.field.name == effect.twin; });
  Soil bare;
  if (twin->number(met) == twin->number(bare)) return std::nullopt;
  return fmt::format(
      "{} would be added to the same force in soil {} ({} = {:g}, by the soil or another effect): state {} "
      "to "
      "add to it, or leave the effect out",
      effect.name, soil_name, effect.twin, twin->number(met), stated);
}

}  // namespace

const Effect* find_effect(std::string_view name) {
  const std::span<const Effect> all = effect_catalogue();
  const auto row = std::find_if(all.begin(), all.end(), [name](const Effect& e) { return e.name == name; });
  return row == all.end() ? nullptr : &*row;
}

std::vector<double> values_of(const Effect& effect, const EffectSetting& setting) {
  std::vector<double> values;
  for (const Field& field : effect.fields) {
    const auto given = setting.parameters.find(std::string(field.name));
    values.push_back(given == setting.parameters.end() ? field.initial : given->second);
  }
  return values;
}

std::vector<Fault> faults_of(std::span<const EffectSetting> settings) {
  std::vector<Fault> faults;
  for (std::size_t i = 0; i < settings.size(); ++i) {
    const EffectSetting& setting = settings[i];
    const auto same = [&](const EffectSetting& other) { return other.name == setting.name; };
    if (std::any_of(settings.begin(), settings.begin() + static_cast<std::ptrdiff_t>(i), same))
      faults.push_back(
          {fmt::format("/{}/name", i), fmt::format("effect \"{}\" is switched on twice", setting.name)});
    if (const Effect* effect = find_effect(setting.name)) {
      check_parameters(*effect, setting, i, faults);
    } else {
      faults.push_back({fmt::format("/{}/name", i), fmt::format("unknown effect \"{}\", known are: {}",
                                                                setting.name, names_of(effect_catalogue()))});
    }
  }
  return faults;
}

std::vector<Fault> faults_of(std::span<const EffectSetting> settings, const RoverModel& rover) {
  std::vector<Fault> faults;
  for (std::size_t i = 0; i < settings.size(); ++i) {
    const Effect* const effect = find_effect(settings[i].name);
    if (effect == nullptr || effect->wheel_field.empty()) continue;
    const auto wheel = settings[i].parameters.find(std::string(effect->wheel_field));
    if (wheel == settings[i].parameters.end()) continue;
    const double last = static_cast<double>(rover.wheels.size()) - 1.0;
    if (wheel->second != std::round(wheel->second) || wheel->second > last)
      faults.push_back(
          {fmt::format("/{}/parameters/{}", i, effect->wheel_field),
           fmt::format("{} = {:g}, must be a whole number up to {:g}: {} has {} wheels", effect->wheel_field,
                       wheel->second, last, rover.name, rover.wheels.size())});
  }
  return faults;
}

std::vector<Fault> doubled(std::span<const EffectSetting> settings, const Soil& soil,
                           std::string_view soil_name) {
  std::vector<Fault> faults;
  for (std::size_t i = 0; i < settings.size(); ++i) {
    const Effect* const effect = find_effect(settings[i].name);
    if (effect == nullptr || effect->on_soil == nullptr || effect->region || !settings[i].on) continue;
    for (std::size_t f = 0; f < effect->fields.size(); ++f) {
      const Field& field = effect->fields[f];
      if (!field.neutral || settings[i].parameters.contains(std::string(field.name))) continue;
      const SoilField* const own = field_of_its_own(*effect, f, soil);
      if (own == nullptr) continue;
      Soil copy = soil;
      faults.push_back(
          {fmt::format("/{}/name", i),
           fmt::format(
               "{} would add {} = {:g} to what soil {} has already ({} = {:g}): state {} to add to it, "
               "or leave the effect out",
               effect->name, field.name, field.initial, soil_name, own->field.name, own->number(copy),
               field.name)});
    }
    if (auto twin = twin_fault(*effect, settings[i], with_others(settings, effect->name, soil), soil_name))
      faults.push_back({fmt::format("/{}/name", i), *std::move(twin)});
  }
  return faults;
}

void apply_effects(std::span<const EffectSetting> settings, RoverModel& rover) {
  for_each_on(settings, [&](const Effect& effect, std::span<const double> values) {
    if (effect.on_rover) effect.on_rover(values, rover);
  });
}

void apply_effects(std::span<const EffectSetting> settings, Soil& soil) {
  for_each_on(settings, [&](const Effect& effect, std::span<const double> values) {
    if (effect.on_soil && !effect.region) effect.on_soil(values, soil);
  });
}

std::vector<Disc> effect_regions(std::span<const EffectSetting> settings) {
  std::vector<Disc> regions;
  for_each_on(settings, [&](const Effect& effect, std::span<const double> values) {
    if (effect.region) regions.push_back(effect.region(values));
  });
  return regions;
}

void apply_in_region(std::span<const EffectSetting> settings, std::size_t region, Soil& soil) {
  std::size_t index = 0;
  for_each_on(settings, [&](const Effect& effect, std::span<const double> values) {
    if (effect.region && index++ == region) effect.on_soil(values, soil);
  });
}

std::vector<EffectSetting> in_force(std::span<const EffectSetting> rovers,
                                    std::span<const EffectSetting> requested) {
  std::vector<EffectSetting> all;
  for (const EffectSetting& own : rovers) {
    const auto same = [&](const EffectSetting& other) { return other.name == own.name; };
    if (std::none_of(requested.begin(), requested.end(), same)) all.push_back(own);
  }
  all.insert(all.end(), requested.begin(), requested.end());
  std::erase_if(all, [](const EffectSetting& setting) { return !setting.on; });
  return all;
}

}  // namespace slipway::sim
