#pragma once

#include <map>
#include <span>
#include <string>
#include <string_view>

#include "core/field.h"
#include "core/result.h"
#include "sim/rover_model.h"
#include "sim/soil.h"

namespace slipway::sim {

// Something beyond the bare Bekker-Wong-Janosi wheel: a name, parameters with ranges, and what it does to the
// model. Off changes nothing, which a property test checks for every row.
struct Effect {
  std::string_view name;
  std::string_view summary;
  std::string_view reference;
  std::span<const Field> fields;
  // What it changes, given one value per field in the fields' order and units; null where it leaves them
  // alone.
  void (*on_rover)(std::span<const double> values, RoverModel& rover);
  void (*on_soil)(std::span<const double> values, Soil& soil);
};

// The explicit list of effects; a new one is a file pair and a row.
std::span<const Effect> effect_catalogue();

// An effect that is switched on, with the parameters that differ from the row's initial values.
struct EffectSetting {
  std::string name;
  std::map<std::string, double> parameters;
};

// Faults (unknown effect, listing the known; unknown parameter; value out of range), with pointers relative
// to the list:
// "/0/parameters/n1".
std::vector<Fault> faults_of(std::span<const EffectSetting> settings);

// Applies settings without faults, in the catalogue's order whatever the list's order. Once per rover and per
// soil.
void apply_effects(std::span<const EffectSetting> settings, RoverModel& rover);
void apply_effects(std::span<const EffectSetting> settings, Soil& soil);

}  // namespace slipway::sim
