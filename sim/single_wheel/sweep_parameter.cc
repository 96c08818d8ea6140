#include "sim/single_wheel/sweep_parameter.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/angle.h"
#include "sim/effects/effect_catalogue.h"

namespace slipway::sim {
namespace {

constexpr std::string_view kEffects = "effects.";

constexpr std::array kParameters{
    SweepParameter{{"slip", "1", "slip, by its definition", -1.0, 1.0, 0.0},
                   [](double v, WheelRig& rig) { rig.test.slip = v; }},
    SweepParameter{{"slip_angle_deg", "deg", "from the wheel's plane to its travel", -90.0, 90.0, 0.0},
                   [](double v, WheelRig& rig) { rig.test.slip_angle_rad = rad_from_deg(v); }},
    SweepParameter{{"load_n", "N", "on the wheel", 0.1, 1e5, 100.0},
                   [](double v, WheelRig& rig) { rig.test.load_n = v; }},
    SweepParameter{{"sinkage_m", "m", "held", 1e-5, 1.0, 0.01},
                   [](double v, WheelRig& rig) { rig.test.sinkage_m = v; }},
    SweepParameter{{"speed_m_s", "m/s", "that is held", 1e-4, 10.0, 0.04},
                   [](double v, WheelRig& rig) { rig.test.speed_m_s = v; }},
    SweepParameter{{"gravity_m_s2", "m/s^2", "of the place", 0.1, 30.0, 3.71},
                   [](double v, WheelRig& rig) { rig.test.gravity_m_s2 = v; }},
    SweepParameter{{"motor_temp_c", "degC", "of the motor", -150.0, 150.0, 20.0},
                   [](double v, WheelRig& rig) { rig.motor_temp_c = v; }},
    SweepParameter{{"wheel.radius_m", "m", "of the rim", 0.01, 2.0, 0.125},
                   [](double v, WheelRig& rig) { rig.rover.wheels[rig.wheel].radius_m = v; }},
    SweepParameter{{"wheel.width_m", "m", "of the rim", 0.01, 2.0, 0.16},
                   [](double v, WheelRig& rig) { rig.rover.wheels[rig.wheel].width_m = v; }},
    SweepParameter{{"soil.k_c", "N/m^(n+1)", "cohesive modulus", -1e10, 1e10, 0.0},
                   [](double v, WheelRig& rig) { rig.soil.pressure.k_c = v; }},
    SweepParameter{{"soil.k_phi", "N/m^(n+2)", "frictional modulus", -1e10, 1e11, 1e6},
                   [](double v, WheelRig& rig) { rig.soil.pressure.k_phi = v; }},
    SweepParameter{{"soil.k_s", "N/m^(n+2)", "k_c / b + k_phi in one", 1.0, 1e11, 1e6},
                   [](double v, WheelRig& rig) {
                     rig.soil.pressure.k_c = 0.0;
                     rig.soil.pressure.k_phi = v;
                   }},
    SweepParameter{{"soil.n", "1", "exponent of sinkage", 0.1, 2.9, 1.0},
                   [](double v, WheelRig& rig) { rig.soil.pressure.n = v; }},
    SweepParameter{{"soil.cohesion_pa", "Pa", "cohesion", 0.0, 1e6, 500.0},
                   [](double v, WheelRig& rig) { rig.soil.cohesion_pa = v; }},
    SweepParameter{{"soil.friction_angle_deg", "deg", "internal friction", 0.1, 60.0, 30.0},
                   [](double v, WheelRig& rig) { rig.soil.friction_angle_rad = rad_from_deg(v); }},
    SweepParameter{{"soil.shear_modulus_x_m", "m", "Janosi-Hanamoto's K, forward", 1e-4, 1.0, 0.01},
                   [](double v, WheelRig& rig) { rig.soil.shear_modulus_x_m = v; }},
    SweepParameter{{"soil.shear_modulus_y_m", "m", "Janosi-Hanamoto's K, sideways", 1e-4, 1.0, 0.01},
                   [](double v, WheelRig& rig) { rig.soil.shear_modulus_y_m = v; }},
    SweepParameter{{"soil.density_kg_m3", "kg/m^3", "of the soil", 100.0, 5000.0, 1500.0},
                   [](double v, WheelRig& rig) { rig.soil.density_kg_m3 = v; }},
    SweepParameter{{"soil.c1", "1", "of the angle of greatest stress", 0.0, 1.0, 0.4},
                   [](double v, WheelRig& rig) { rig.soil.c1 = v; }},
    SweepParameter{{"soil.c2", "1", "of the angle of greatest stress", -1.0, 1.0, 0.2},
                   [](double v, WheelRig& rig) { rig.soil.c2 = v; }},
    SweepParameter{{"soil.exit_angle_ratio", "1", "exit over entry angle", 0.0, 1.0, 0.0},
                   [](double v, WheelRig& rig) { rig.soil.exit_angle_ratio = v; }},
    SweepParameter{{"soil.shear_coupling", "1", "0 independent, 1 one resultant", 0.0, 1.0, 0.0},
                   [](double v, WheelRig& rig) { rig.soil.shear_coupling = v; }},
};

// "effects.grousers.height_m" -> {"grousers", "height_m"}.
std::optional<std::pair<std::string, std::string>> effect_and_field(std::string_view name) {
  if (!name.starts_with(kEffects)) return std::nullopt;
  name.remove_prefix(kEffects.size());
  const std::size_t dot = name.find('.');
  if (dot == std::string_view::npos) return std::nullopt;
  return std::pair(std::string(name.substr(0, dot)), std::string(name.substr(dot + 1)));
}

}  // namespace

SingleWheelTest test_of(const WheelRig& rig) {
  const std::vector<EffectSetting> effects = in_force(rig.rover.effects, rig.effects);
  RoverModel rover = rig.rover;
  SingleWheelTest test = rig.test;
  test.soil = rig.soil;
  apply_effects(effects, rover);
  apply_effects(effects, test.soil);
  test.wheel = rover.wheels[rig.wheel].geometry();
  test.drive = at_temperature(rover.drive, rig.motor_temp_c.value_or(rover.drive.reference_temp_c));
  return test;
}

std::span<const SweepParameter> sweep_parameters() {
  return kParameters;
}

bool acts_on_single_wheel(std::string_view effect) {
  const Effect* row = find_effect(effect);
  if (row == nullptr || row->region != nullptr) return false;
  if (row->on_soil != nullptr) return true;
  // A rover effect acts where a wheel or the motor comes out different.
  RoverModel before;
  before.wheels.resize(1);
  RoverModel after = before;
  EffectSetting setting{.name = std::string(effect), .parameters = {}};
  apply_effects(std::span(&setting, 1), after);
  const WheelGeometry a = before.wheels[0].geometry(), b = after.wheels[0].geometry();
  const auto currents = [](const RoverModel& rover) {
    return motor_state(at_temperature(rover.drive, 60.0), 10.0, 0.3).current_a;
  };
  return a.radius_m != b.radius_m || a.width_m != b.width_m || a.rim_friction != b.rim_friction ||
         a.grousers.height_m != b.grousers.height_m || a.grousers.count != b.grousers.count ||
         currents(before) != currents(after);
}

std::optional<Field> sweep_field(std::string_view name) {
  for (const SweepParameter& parameter : kParameters) {
    if (parameter.field.name == name) return parameter.field;
  }
  const auto parts = effect_and_field(name);
  if (!parts || !acts_on_single_wheel(parts->first)) return std::nullopt;
  for (const Field& field : find_effect(parts->first)->fields) {
    if (field.name == parts->second) return field;
  }
  return std::nullopt;
}

std::vector<std::string> sweep_field_names() {
  std::vector<std::string> names;
  for (const SweepParameter& parameter : kParameters) names.emplace_back(parameter.field.name);
  for (const Effect& effect : effect_catalogue()) {
    if (!acts_on_single_wheel(effect.name)) continue;
    for (const Field& field : effect.fields)
      names.push_back(std::string(kEffects) + std::string(effect.name) + "." + std::string(field.name));
  }
  return names;
}

void set_sweep_parameter(std::string_view name, double value, WheelRig& rig) {
  for (const SweepParameter& parameter : kParameters) {
    if (parameter.field.name == name) return parameter.set(value, rig);
  }
  const auto parts = effect_and_field(name);
  if (!parts) return;
  // The rover's own setting of this effect is the base, unless the request has one.
  const auto named = [&](const EffectSetting& s) { return s.name == parts->first; };
  auto setting = std::find_if(rig.effects.begin(), rig.effects.end(), named);
  if (setting == rig.effects.end()) {
    const auto own = std::find_if(rig.rover.effects.begin(), rig.rover.effects.end(), named);
    rig.effects.push_back(
        own == rig.rover.effects.end() ? EffectSetting{.name = parts->first, .parameters = {}} : *own);
    setting = rig.effects.end() - 1;
  }
  setting->on = true;
  setting->parameters[parts->second] = value;
}

}  // namespace slipway::sim
