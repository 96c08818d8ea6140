#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "sim/effects/effect.h"
#include "sim/rover/effect_setting.h"
#include "sim/rover/rover_model.h"
#include "sim/soil/soil.h"

namespace slipway::sim {

// The explicit list of effects, see effect_rows.cc; a new one is a file pair in sim/effects and a row there.
std::span<const Effect> effect_catalogue();
// Null where the catalogue does not have this name.
const Effect* find_effect(std::string_view name);

// Faults (unknown effect, listing the known; unknown parameter; value out of range), with pointers relative
// to the list: "/0/parameters/n1".
std::vector<Fault> faults_of(std::span<const EffectSetting> settings);

// What is wrong with settings (without faults of their own) for this rover: a wheel that it does not have.
std::vector<Fault> faults_of(std::span<const EffectSetting> settings, const RoverModel& rover);

// What settings (without faults of their own) would add, by numbers that nobody stated, to what a soil has
// already: an effect's initial numbers describe a soil that has none of its kind.
std::vector<Fault> doubled(std::span<const EffectSetting> settings, const Soil& soil,
                           std::string_view soil_name);

// The rover's own settings with the request's added: a name in the request replaces the rover's, `on` = false
// takes it out. Only settings that are on are left.
std::vector<EffectSetting> in_force(std::span<const EffectSetting> rovers,
                                    std::span<const EffectSetting> requested);

// Applies settings without faults that are on, in the catalogue's order whatever the list's order. Once per
// rover and per soil. The soil form leaves out effects that are at work in a region only.
void apply_effects(std::span<const EffectSetting> settings, RoverModel& rover);
void apply_effects(std::span<const EffectSetting> settings, Soil& soil);

// One value for each of the effect's fields, in their order: what is set, else the initial value.
std::vector<double> values_of(const Effect& effect, const EffectSetting& setting);

// The places where soils differ from the rest of the map, in the catalogue's order, and what happens to a
// soil (that apply_effects has changed) in one of them.
std::vector<Disc> effect_regions(std::span<const EffectSetting> settings);
void apply_in_region(std::span<const EffectSetting> settings, std::size_t region, Soil& soil);

}  // namespace slipway::sim
