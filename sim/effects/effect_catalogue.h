#pragma once

#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "core/field.h"
#include "core/result.h"
#include "sim/rover/effect_setting.h"
#include "sim/rover/rover_model.h"
#include "sim/soil/soil.h"

namespace slipway::sim {

// A round place on the map, frame M.
struct Disc {
  double x_m = 0.0, y_m = 0.0, radius_m = 0.0;

  bool holds(double x, double y) const {
    return (x - x_m) * (x - x_m) + (y - y_m) * (y - y_m) < radius_m * radius_m;
  }
};

// Something beyond the bare Bekker-Wong-Janosi wheel: a name, parameters with ranges, and what it does to the
// model. Off, or with its neutral numbers, it changes nothing, which property tests check for every
// row. The names are the contract of the gap diagnosis.
struct Effect {
  std::string_view name;
  std::string_view summary;
  std::string_view reference;
  std::span<const Field> fields;
  // What it changes, given one value per field in the fields' order and units; null where it leaves them
  // alone.
  void (*on_rover)(std::span<const double> values, RoverModel& rover) = nullptr;
  void (*on_soil)(std::span<const double> values, Soil& soil) = nullptr;
  // Where on_soil is at work; null: everywhere.
  Disc (*region)(std::span<const double> values) = nullptr;
};

// The explicit list of effects; a new one is a file pair in sim/effects and a row.
std::span<const Effect> effect_catalogue();
const Effect* find_effect(std::string_view name);

// Faults (unknown effect, listing the known; unknown parameter; value out of range), with pointers relative
// to the list: "/0/parameters/n1".
std::vector<Fault> faults_of(std::span<const EffectSetting> settings);

// What is wrong with settings (without faults of their own) for this rover: a wheel that it does not have.
std::vector<Fault> faults_of(std::span<const EffectSetting> settings, const RoverModel& rover);

// The rover's own settings with the request's added: a name in the request replaces the rover's, `on` = false
// takes it out. Only settings that are on are left.
std::vector<EffectSetting> in_force(std::span<const EffectSetting> rovers,
                                    std::span<const EffectSetting> requested);

// Applies settings without faults that are on, in the catalogue's order whatever the list's order. Once per
// rover and per soil. The soil form leaves out effects that are at work in a region only.
void apply_effects(std::span<const EffectSetting> settings, RoverModel& rover);
void apply_effects(std::span<const EffectSetting> settings, Soil& soil);

// The places where soils differ from the rest of the map, in the catalogue's order, and what happens to a
// soil (that apply_effects has changed) in one of them.
std::vector<Disc> effect_regions(std::span<const EffectSetting> settings);
void apply_in_region(std::span<const EffectSetting> settings, std::size_t region, Soil& soil);

}  // namespace slipway::sim
