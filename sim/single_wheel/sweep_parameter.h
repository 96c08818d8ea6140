#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/field.h"
#include "sim/rover/effect_setting.h"
#include "sim/rover/rover_model.h"
#include "sim/single_wheel/single_wheel_rig.h"
#include "sim/soil/soil.h"

namespace slipway::sim {

// A single-wheel test before effects: what a sweep varies, and what a test is made of.
struct WheelRig {
  RoverModel rover;  // its wheel and motor are tested; its own effects are at work
  std::size_t wheel = 0;
  Soil soil;                           // of the place, without effects
  std::vector<EffectSetting> effects;  // added to the rover's own
  std::optional<double> motor_temp_c;  // nothing: the temperature its motor is given at
  SingleWheelTest test;                // wheel, soil and drive in it are filled in by test_of
};

// The test with wheel, soil and motor as the effects make them.
SingleWheelTest test_of(const WheelRig& rig);

// One number of a rig that a sweep can vary, in the unit of the boundary.
struct SweepParameter {
  Field field;  // "slip", "load_n", "soil.n", "wheel.radius_m"
  void (*set)(double value, WheelRig& rig);
};

// Test conditions, wheel and soil. soil.k_s sets k_c = 0 and k_phi = k_s, as in the Zhurong paper's
// section 3.2.
std::span<const SweepParameter> sweep_parameters();

// The range of a parameter of the list above or "effects.NAME.PARAMETER"; nothing where there is none, or
// where the effect has no bearing on a single wheel.
std::optional<Field> sweep_field(std::string_view name);
// All names that sweep_field knows.
std::vector<std::string> sweep_field_names();
// `name` is one that sweep_field knows. An effect that is off is switched on.
void set_sweep_parameter(std::string_view name, double value, WheelRig& rig);

// Whether an effect changes anything of a single wheel on a rig: its soil, its geometry or its motor.
bool acts_on_single_wheel(std::string_view effect);

}  // namespace slipway::sim
