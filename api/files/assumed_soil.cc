#include "api/files/assumed_soil.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace slipway::api::json {
namespace {

JsonValue number_value(double number) {
  JsonValue value;
  value.kind = JsonValue::Kind::kNumber;
  value.number = number;
  return value;
}

// Gives the object a member that it does not have.
bool give(JsonValue& object, const char* key, JsonValue value) {
  if (object.find(key) != nullptr) return false;
  object.keys.emplace_back(key);
  object.elements.push_back(std::move(value));
  return true;
}

}  // namespace

std::vector<std::string> give_what_is_assumed(JsonValue& soil) {
  std::vector<std::string> assumed;
  constexpr double kSand = 0.25, kUnknown = 0.5;  // spreads of ratios
  if (!soil.is(JsonValue::Kind::kObject) || soil.find("slip_curve") != nullptr) return assumed;
  const auto number = [&](const char* key, double value, const char* unit) {
    const bool is_given = give(soil, key, number_value(value));
    if (is_given) assumed.push_back(fmt::format("{}: {:g}{}, as shipped sands have", key, value, unit));
    return is_given;
  };
  const bool is_sheared_unknown = number("shear_modulus_x_m", 0.0152, " m");
  number("density_kg_m3", 1500.0, " kg/m^3");
  number("c1", 0.18, "");
  number("c2", 0.32, "");
  number("correlation_length_m", 5.0, " m");
  if (is_sheared_unknown) number("slip_error", 0.5, "");
  const JsonValue* const cohesion = soil.find("cohesion_pa");
  const double cohesion_pa =
      cohesion != nullptr && cohesion->is(JsonValue::Kind::kNumber) ? cohesion->number : 0.0;
  JsonValue std;
  std.kind = JsonValue::Kind::kObject;
  give(std, "stiffness_ratio", number_value(kSand));
  give(std, "n", number_value(0.05));
  give(std, "cohesion_pa", number_value(0.3 * std::max(cohesion_pa, 0.0)));
  give(std, "friction_angle_deg", number_value(2.0));
  give(std, "shear_modulus_ratio", number_value(is_sheared_unknown ? kUnknown : kSand));
  if (give(soil, "std", std::move(std))) assumed.emplace_back("std: the usual scatter of such tests");
  return assumed;
}

}  // namespace slipway::api::json
