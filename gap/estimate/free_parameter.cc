#include "gap/estimate/free_parameter.h"

#include <algorithm>

#include "sim/single_wheel/sweep_parameter.h"

namespace slipway::gap {
namespace {

constexpr std::string_view kSoil = "soil.", kEffects = "effects.", kWheel = "wheel.";

// One of the seven by its own name or by that of its key in a soil's file.
std::optional<SoilParameter> one_of_seven(std::string_view name) {
  if (const auto parameter = soil_parameter(name)) return parameter;
  // K of a soil's file is along one direction; the seven scale both.
  for (const SoilParameterRow& row : soil_parameter_rows())
    if (row.field != nullptr && row.field->field.name == name &&
        row.parameter != SoilParameter::kShearModulus)
      return row.parameter;
  return std::nullopt;
}

std::optional<FreeParameter> further(std::string_view name, std::string swept) {
  const auto field = sim::sweep_field(swept);
  if (!field) return std::nullopt;
  FreeParameter parameter(SoilParameter::kN);
  parameter.name = std::string(name);
  parameter.soil.reset();
  parameter.swept = std::move(swept);
  parameter.field = *field;
  return parameter;
}

std::optional<FreeParameter> parameter_named(std::string_view name) {
  const bool of_soil = name.starts_with(kSoil), of_effect = name.starts_with(kEffects);
  if (of_soil) name.remove_prefix(kSoil.size());
  if (of_effect) name.remove_prefix(kEffects.size());
  if (name.starts_with(kWheel)) return of_soil || of_effect ? std::nullopt : further(name, std::string(name));
  if (!of_effect) {
    if (const auto parameter = one_of_seven(name)) return FreeParameter(*parameter);
    // Both moduli in one is k_bekker here.
    if (auto of = name == "k_s" ? std::nullopt : further(name, std::string(kSoil).append(name))) return of;
  }
  return of_soil ? std::nullopt : further(name, std::string(kEffects).append(name));
}

}  // namespace

FreeParameter::FreeParameter(SoilParameter parameter) : name(row_of(parameter).name), soil(parameter) {}

std::string_view FreeParameter::unit() const {
  return soil ? row_of(*soil).unit : field.unit;
}
double FreeParameter::boundary_unit() const {
  return soil ? row_of(*soil).boundary_unit : 1.0;
}
bool FreeParameter::is_of_soil() const {
  return soil || swept.starts_with(kSoil);
}
bool FreeParameter::is_of_effect() const {
  return !soil && swept.starts_with(kEffects);
}

bool operator==(const FreeParameter& a, const FreeParameter& b) {
  return a.name == b.name && a.of == b.of;
}

std::optional<FreeParameter> free_parameter(std::string_view text) {
  const std::size_t at = text.find('@');
  auto parameter = parameter_named(text.substr(0, at));
  if (!parameter || at == std::string_view::npos) return parameter;
  parameter->of = std::string(text.substr(at + 1));
  if (parameter->of.empty()) return std::nullopt;
  return parameter;
}

std::vector<std::string> free_parameter_names() {
  std::vector<std::string> names;
  for (const SoilParameterRow& row : soil_parameter_rows()) names.emplace_back(row.name);
  for (const std::string& swept : sim::sweep_field_names()) {
    std::string_view name = swept;
    if (name.starts_with(kSoil))
      name.remove_prefix(kSoil.size());
    else if (name.starts_with(kEffects))
      name.remove_prefix(kEffects.size());
    else if (!name.starts_with(kWheel))
      continue;  // a condition of the test
    if (name == "k_s" || one_of_seven(name)) continue;
    names.emplace_back(name);
  }
  return names;
}

}  // namespace slipway::gap
