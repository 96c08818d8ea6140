#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/field.h"
#include "sim/rover/effect_setting.h"
#include "sim/rover/rover_model.h"
#include "sim/single_wheel/single_wheel_rig.h"
#include "sim/soil/soil_field.h"

namespace slipway::sim {

// A wheel on a rig before effects: what a sweep varies, and what the rig's conditions are made of.
struct WheelRig {
  RoverModel rover;  // its wheel and motor are on the rig; its own effects are at work
  std::size_t wheel = 0;
  Soil soil;                           // of the place, without effects
  std::vector<EffectSetting> effects;  // added to the rover's own
  std::optional<double> motor_temp_c;  // nothing: the temperature its motor is given at
  WheelRigConditions test;             // wheel, soil and drive in it are filled in by conditions_of
  const SoilFormat* soil_format = &sim::soil_format();  // whose fields and laws can be swept
};

// The conditions with wheel, soil and motor as the effects make them.
WheelRigConditions conditions_of(const WheelRig& rig);

// The range of what a sweep can vary, in the unit of the boundary; nothing where there is no such name, or
// where an effect has no bearing on a single wheel. Names are those of the rig's conditions ("slip",
// "load_n"), "wheel." and "soil." with a field of the rover's and the soil's file ("wheel.radius_m",
// "soil.n"), "soil.LAW.PARAMETER" of a law of the soil's format ("soil.reece.k_phi") and
// "effects.NAME.PARAMETER". soil.k_s sets k_c = 0 and k_phi = k_s, as in the Zhurong paper's section 3.2.
std::optional<Field> sweep_field(std::string_view name, const SoilFormat& format = soil_format());
// All names that sweep_field knows.
std::vector<std::string> sweep_field_names(const SoilFormat& format = soil_format());
// `name` is one that sweep_field knows with the rig's format. An effect that is off is switched on.
void set_sweep_parameter(std::string_view name, double value, WheelRig& rig);
// The value at which the rig has what set_sweep_parameter sets, in the unit of the boundary; of an effect
// that is off what it would be switched on with. Nothing for a condition of the test and for soil.k_s.
std::optional<double> sweep_parameter_value(std::string_view name, const WheelRig& rig);
// Why this rig's soil has no such parameter: moduli of Bekker's law on a soil with another law, or the
// parameters of a law that it did not choose.
std::optional<std::string> not_of_this_soil(std::string_view name, const Soil& soil);

// Whether an effect changes anything of a single wheel on a rig: its soil, its geometry or its motor.
bool acts_on_single_wheel(std::string_view effect);

}  // namespace slipway::sim
