#include "sim/single_wheel/sweep_parameter.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/angle.h"
#include "sim/effects/effect_catalogue.h"
#include "sim/rover/rover_field.h"

namespace slipway::sim {
namespace {

constexpr std::string_view kEffects = "effects.";

constexpr std::string_view kSoil = "soil.";
constexpr std::string_view kWheel = "wheel.";

// One number of the rig itself, in the unit of the boundary.
struct Condition {
  Field field;
  void (*set)(double value, WheelRig& rig);
};

constexpr std::array kConditions{
    Condition{{"slip", "1", "slip, by its definition", -1.0, 1.0, 0.0},
              [](double v, WheelRig& rig) { rig.test.slip = v; }},
    Condition{{"slip_angle_deg", "deg", "from the wheel's plane to its travel", -90.0, 90.0, 0.0},
              [](double v, WheelRig& rig) { rig.test.slip_angle_rad = rad_from_deg(v); }},
    Condition{{"slope_deg", "deg", "that the wheel climbs, at the slip that follows", -45.0, 45.0, 10.0},
              [](double v, WheelRig& rig) { rig.test.slope_rad = rad_from_deg(v); }},
    Condition{{"load_n", "N", "on the wheel", 0.1, 1e5, 100.0},
              [](double v, WheelRig& rig) { rig.test.load_n = v; }},
    Condition{{"sinkage_m", "m", "held", 1e-5, 1.0, 0.01},
              [](double v, WheelRig& rig) { rig.test.sinkage_m = v; }},
    Condition{{"speed_m_s", "m/s", "that is held", 1e-4, 10.0, 0.04},
              [](double v, WheelRig& rig) { rig.test.speed_m_s = v; }},
    Condition{{"gravity_m_s2", "m/s^2", "of the place", 0.1, 30.0, 3.71},
              [](double v, WheelRig& rig) { rig.test.gravity_m_s2 = v; }},
    Condition{{"motor_temp_c", "degC", "of the motor", -150.0, 150.0, 20.0},
              [](double v, WheelRig& rig) { rig.motor_temp_c = v; }},
};

// Both moduli of Bekker's law as one.
constexpr Field kStiffness{"soil.k_s", "N/m^(n+2)", "k_c / b + k_phi in one", 1.0, 1e11, 1e6};

const Condition* find_condition(std::string_view name) {
  const auto found = std::find_if(kConditions.begin(), kConditions.end(),
                                  [&](const Condition& row) { return row.field.name == name; });
  return found == kConditions.end() ? nullptr : &*found;
}

const ModelField<WheelModel>* find_wheel_field(std::string_view name) {
  if (!name.starts_with(kWheel)) return nullptr;
  for (const ModelField<WheelModel>& row : wheel_fields())
    if (row.field.name == name.substr(kWheel.size())) return &row;
  return nullptr;
}

const SoilField* field_of_soil(std::string_view name, const SoilFormat& format) {
  return name.starts_with(kSoil) ? find_soil_field(name.substr(kSoil.size()), format) : nullptr;
}

// A parameter of a law, "soil.reece.k_c": its place among the law's fields.
template <class Law>
struct LawParameter {
  const Law* law = nullptr;
  std::size_t place = 0;
};

template <class Law>
LawParameter<Law> law_parameter(std::string_view name, std::span<const Law* const> laws) {
  if (!name.starts_with(kSoil)) return {};
  name.remove_prefix(kSoil.size());
  const std::size_t dot = name.find('.');
  if (dot == std::string_view::npos) return {};
  for (const Law* law : laws) {
    if (law->name != name.substr(0, dot)) continue;
    for (std::size_t i = 0; i < law->fields.size(); ++i)
      if (law->fields[i].name == name.substr(dot + 1)) return {law, i};
  }
  return {};
}

template <class Law>
void add_names(std::span<const Law* const> laws, std::vector<std::string>& names) {
  for (const Law* law : laws)
    for (const Field& field : law->fields)
      names.push_back(std::string(kSoil) + std::string(law->name) + "." + std::string(field.name));
}

// "effects.grousers.height_m" -> {"grousers", "height_m"}.
std::optional<std::pair<std::string, std::string>> effect_and_field(std::string_view name) {
  if (!name.starts_with(kEffects)) return std::nullopt;
  name.remove_prefix(kEffects.size());
  const std::size_t dot = name.find('.');
  if (dot == std::string_view::npos) return std::nullopt;
  return std::pair(std::string(name.substr(0, dot)), std::string(name.substr(dot + 1)));
}

}  // namespace

WheelRigConditions conditions_of(const WheelRig& rig) {
  const std::vector<EffectSetting> effects = in_force(rig.rover.effects, rig.effects);
  RoverModel rover = rig.rover;
  WheelRigConditions test = rig.test;
  test.soil = rig.soil;
  apply_effects(effects, rover);
  apply_effects(effects, test.soil);
  test.wheel = rover.wheels[rig.wheel].geometry();
  test.drive = at_temperature(rover.drive, rig.motor_temp_c.value_or(rover.drive.reference_temp_c));
  return test;
}

bool acts_on_single_wheel(std::string_view effect) {
  const Effect* row = find_effect(effect);
  if (row == nullptr || row->region != nullptr) return false;
  if (row->on_soil != nullptr) return true;
  // A rover effect acts where a wheel, with grousers, or the motor comes out different.
  RoverModel before;
  before.wheels.resize(1);
  before.wheels[0].grousers = Grousers{.height_m = 0.003, .count = 7.0};
  RoverModel after = before;
  EffectSetting setting{.name = std::string(effect), .parameters = {}};
  apply_effects(std::span(&setting, 1), after);
  const WheelGeometry a = before.wheels[0].geometry(), b = after.wheels[0].geometry();
  const auto currents = [](const RoverModel& rover) {
    return motor_state(at_temperature(rover.drive, 60.0), 10.0, 0.3).current_a;
  };
  return a.radius_m != b.radius_m || a.width_m != b.width_m || a.rim_friction != b.rim_friction ||
         a.grousers.height_m != b.grousers.height_m || a.grousers.count != b.grousers.count ||
         a.grousers.shear_share != b.grousers.shear_share || a.grousers.surcharge != b.grousers.surcharge ||
         a.grousers.shear_by_spacing != b.grousers.shear_by_spacing || currents(before) != currents(after);
}

std::optional<Field> sweep_field(std::string_view name, const SoilFormat& format) {
  if (const Condition* condition = find_condition(name)) return condition->field;
  if (const auto* wheel = find_wheel_field(name)) return wheel->field;
  if (name == kStiffness.name) return kStiffness;
  if (const SoilField* soil = field_of_soil(name, format)) return soil->field;
  if (const auto pressure = law_parameter(name, format.laws.pressure); pressure.law != nullptr)
    return pressure.law->fields[pressure.place];
  if (const auto shear = law_parameter(name, format.laws.shear); shear.law != nullptr)
    return shear.law->fields[shear.place];
  const auto parts = effect_and_field(name);
  if (!parts || !acts_on_single_wheel(parts->first)) return std::nullopt;
  for (const Field& field : find_effect(parts->first)->fields) {
    if (field.name == parts->second) return field;
  }
  return std::nullopt;
}

std::vector<std::string> sweep_field_names(const SoilFormat& format) {
  std::vector<std::string> names;
  names.reserve(kConditions.size() + wheel_fields().size() + format.fields.size());
  for (const Condition& condition : kConditions) names.emplace_back(condition.field.name);
  for (const ModelField<WheelModel>& row : wheel_fields())
    names.push_back(std::string(kWheel) + std::string(row.field.name));
  names.emplace_back(kStiffness.name);
  for (const SoilField& row : format.fields)
    names.push_back(std::string(kSoil) + std::string(row.field.name));
  add_names(format.laws.pressure, names);
  add_names(format.laws.shear, names);
  for (const Effect& effect : effect_catalogue()) {
    if (!acts_on_single_wheel(effect.name)) continue;
    for (const Field& field : effect.fields)
      names.push_back(std::string(kEffects) + std::string(effect.name) + "." + std::string(field.name));
  }
  return names;
}

std::optional<std::string> not_of_this_soil(std::string_view name, const Soil& soil) {
  if (!name.starts_with(kSoil)) return std::nullopt;
  const std::string_view key = name.substr(kSoil.size());
  const std::string_view pressure = row_of(soil.pressure_law).name, shear = row_of(soil.shear_law).name;
  if (key == "k_c" || key == "k_phi" || key == "k_s") {
    if (soil.pressure_law.row == nullptr) return std::nullopt;
    return fmt::format("{} is a modulus of Bekker's law, the soil has the pressure law {}", name, pressure);
  }
  const std::size_t dot = key.find('.');
  if (dot == std::string_view::npos || key.substr(0, dot) == pressure || key.substr(0, dot) == shear)
    return std::nullopt;
  return fmt::format("{} is a parameter of the law {}, the soil has the pressure law {} and the shear law {}",
                     name, key.substr(0, dot), pressure, shear);
}

void set_sweep_parameter(std::string_view name, double value, WheelRig& rig) {
  if (const Condition* condition = find_condition(name)) return condition->set(value, rig);
  if (const auto* wheel = find_wheel_field(name)) {
    wheel->number(rig.rover.wheels[rig.wheel]) = wheel->from_boundary(value);
    return;
  }
  if (name == kStiffness.name) {
    rig.soil.pressure.k_c = 0.0;
    rig.soil.pressure.k_phi = value;
    return;
  }
  if (const SoilField* soil = field_of_soil(name, *rig.soil_format)) {
    soil->number(rig.soil) = soil->from_boundary(value);
    return;
  }
  if (const auto pressure = law_parameter(name, rig.soil_format->laws.pressure); pressure.law != nullptr) {
    rig.soil.pressure_law.parameters[pressure.place] = value;
    return;
  }
  if (const auto shear = law_parameter(name, rig.soil_format->laws.shear); shear.law != nullptr) {
    rig.soil.shear_law.parameters[shear.place] = value;
    return;
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

std::optional<double> sweep_parameter_value(std::string_view name, const WheelRig& rig) {
  if (const auto* row = find_wheel_field(name)) {
    WheelModel wheel = rig.rover.wheels[rig.wheel];
    return row->to_boundary(row->number(wheel));
  }
  if (const SoilField* row = field_of_soil(name, *rig.soil_format)) {
    Soil soil = rig.soil;
    return row->to_boundary(row->number(soil));
  }
  if (const auto pressure = law_parameter(name, rig.soil_format->laws.pressure); pressure.law != nullptr)
    return rig.soil.pressure_law.parameters[pressure.place];
  if (const auto shear = law_parameter(name, rig.soil_format->laws.shear); shear.law != nullptr)
    return rig.soil.shear_law.parameters[shear.place];
  const auto parts = effect_and_field(name);
  if (!parts || find_effect(parts->first) == nullptr) return std::nullopt;
  EffectSetting setting{.name = parts->first, .parameters = {}};
  for (const EffectSetting& on : in_force(rig.rover.effects, rig.effects))
    if (on.name == parts->first) setting = on;
  const Effect& effect = *find_effect(parts->first);
  const std::vector<double> values = values_of(effect, setting);
  for (std::size_t i = 0; i < values.size(); ++i)
    if (effect.fields[i].name == parts->second) return values[i];
  return std::nullopt;
}

}  // namespace slipway::sim
