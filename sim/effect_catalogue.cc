#include "sim/effect_catalogue.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <vector>

#include "sim/com_offset.h"
#include "sim/slip_sinkage.h"
#include "sim/wheel_radius.h"

namespace slipway::sim {
namespace {

std::span<const Effect> rows() {
  static const std::array kRows{kSlipSinkage, kComOffset, kWheelRadius};
  return kRows;
}

const Effect* find(std::string_view name) {
  const auto all = rows();
  const auto row = std::find_if(all.begin(), all.end(), [name](const Effect& e) { return e.name == name; });
  return row == all.end() ? nullptr : &*row;
}

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
  for (const Effect& effect : rows()) {
    const auto is_this = [&](const EffectSetting& s) { return s.name == effect.name; };
    const auto setting = std::find_if(settings.begin(), settings.end(), is_this);
    if (setting == settings.end()) continue;
    std::vector<double> values;
    for (const Field& field : effect.fields) {
      const auto given = setting->parameters.find(std::string(field.name));
      values.push_back(given == setting->parameters.end() ? field.initial : given->second);
    }
    act(effect, values);
  }
}

}  // namespace

std::span<const Effect> effect_catalogue() {
  return rows();
}

std::vector<Fault> faults_of(std::span<const EffectSetting> settings) {
  std::vector<Fault> faults;
  for (std::size_t i = 0; i < settings.size(); ++i) {
    const EffectSetting& setting = settings[i];
    const auto same = [&](const EffectSetting& other) { return other.name == setting.name; };
    if (std::any_of(settings.begin(), settings.begin() + static_cast<std::ptrdiff_t>(i), same))
      faults.push_back(
          {fmt::format("/{}/name", i), fmt::format("effect \"{}\" is switched on twice", setting.name)});
    if (const Effect* effect = find(setting.name)) {
      check_parameters(*effect, setting, i, faults);
    } else {
      faults.push_back({fmt::format("/{}/name", i),
                        fmt::format("unknown effect \"{}\", known are: {}", setting.name, names_of(rows()))});
    }
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
    if (effect.on_soil) effect.on_soil(values, soil);
  });
}

}  // namespace slipway::sim
