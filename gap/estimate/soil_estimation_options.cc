#include "gap/estimate/soil_estimation_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace slipway::gap {

namespace {

// What is free twice, and what is of no wheel or soil of the tests.
void check_free(std::span<const FreeParameter> free, const SoilData& data, std::vector<Fault>& faults) {
  for (std::size_t i = 0; i < free.size(); ++i) {
    const FreeParameter& p = free[i];
    const std::string pointer = fmt::format("/free/{}", i);
    for (std::size_t before = 0; before < i; ++before) {
      if (free[before].name != p.name) continue;
      if (free[before].of == p.of)
        faults.push_back({pointer, fmt::format("{} is given more than once", p.shown())});
      else if (free[before].of.empty() || p.of.empty())
        faults.push_back(
            {pointer, fmt::format("{} and {}: one of them is of all", free[before].shown(), p.shown())});
    }
    if (p.of.empty()) continue;
    const bool of_a_soil = std::find(data.soils.begin(), data.soils.end(), p.of) != data.soils.end();
    const bool of_a_wheel = std::any_of(data.rigs.begin(), data.rigs.end(),
                                        [&](const TestRig& rig) { return rig.wheel == p.of; });
    if (!of_a_soil && !of_a_wheel)
      faults.push_back({pointer, fmt::format("{}: no test has a wheel or soil of this name", p.shown())});
    else if (p.is_of_soil() && !of_a_soil)
      faults.push_back(
          {pointer, fmt::format("{}: a number of a soil is one for all wheels in it", p.shown())});
  }
}

// The moduli that stand for each other, for every label that has one.
void check_moduli(std::span<const FreeParameter> free, std::vector<Fault>& faults) {
  std::vector<std::string> labels;
  for (const FreeParameter& p : free)
    if (std::find(labels.begin(), labels.end(), p.of) == labels.end()) labels.push_back(p.of);
  const auto is_free = [&](FreeParameter parameter, const std::string& of) {
    parameter.of = of;
    return holds(free, parameter);
  };
  for (const std::string& of : labels) {
    const bool k_c = is_free(SoilParameter::kKc, of), k_phi = is_free(SoilParameter::kKphi, of);
    if (k_c != k_phi)
      faults.push_back({"/free", "k_c and k_phi are free together, or k_bekker in their place"});
    if (k_c && k_phi && is_free(SoilParameter::kBekker, of))
      faults.push_back({"/free", "k_bekker stands for k_c and k_phi: give it or them"});
    for (const char* one : {"shear_modulus_x_m", "shear_modulus_y_m"})
      if (is_free(SoilParameter::kShearModulus, of) && is_free(*free_parameter(one), of))
        faults.push_back({"/free", fmt::format("shear_modulus stands for {}: give it or that", one)});
  }
}

// The range that its file holds, at the boundary.
Field field_of(const FreeParameter& parameter) {
  if (!parameter.soil) return parameter.field;
  const SoilParameterRow& row = row_of(*parameter.soil);
  return row.field ? row.field->field : Field{"k_bekker", row.unit, "", 1e-6, 1e11};
}

}  // namespace

bool holds(std::span<const FreeParameter> list, const FreeParameter& parameter) {
  return std::find(list.begin(), list.end(), parameter) != list.end();
}

std::optional<SoilPriors> soil_priors(std::string_view name) {
  if (name == "none") return SoilPriors::kNone;
  if (name == "wide") return SoilPriors::kWide;
  if (name == "soil") return SoilPriors::kSoil;
  return std::nullopt;
}

std::vector<FreeParameter> usual_free_parameters(const SoilData& data) {
  const SoilObservations observations(data, {}, {true, true, true, true, true, true, true});
  std::vector<FreeParameter> free;
  if (observations.one_width())
    free.assign({SoilParameter::kBekker, SoilParameter::kN});
  else
    free.assign({SoilParameter::kKc, SoilParameter::kKphi, SoilParameter::kN});
  if (!data.wheels.empty())
    free.insert(free.end(),
                {SoilParameter::kCohesion, SoilParameter::kFrictionAngle, SoilParameter::kShearModulus});
  return free;
}

std::vector<Fault> faults_of(std::span<const FreeParameter> free, const SoilData& data,
                             const SoilEstimationOptions& options) {
  std::vector<Fault> faults;
  check_free(free, data, faults);
  check_moduli(free, faults);
  for (std::size_t i = 0; i < options.bounds.size(); ++i) {
    const SoilBound& bound = options.bounds[i];
    const std::string pointer = fmt::format("/bounds/{}", i);
    if (!holds(free, bound.parameter))
      faults.push_back({pointer, fmt::format("{} is not free", bound.parameter.shown())});
    else if (bound.parameter.soil == SoilParameter::kKphi)
      faults.push_back({pointer, "k_phi follows from k_c and the stiffness: bound k_c"});
    // Beyond what a soil's file may hold, the estimate could not be read back.
    const Field field = field_of(bound.parameter);
    for (const double value : {bound.lowest, bound.highest})
      if (const double shown = bound.parameter.boundary_unit() * value, near = 1e-12 * std::abs(shown);
          shown < field.lowest - near || shown > field.highest + near)
        faults.push_back({pointer, fmt::format("{} = {:g}, must be in [{:g}, {:g}], which {} holds",
                                               bound.parameter.shown(), shown, field.lowest, field.highest,
                                               bound.parameter.is_of_soil() ? "a soil's file" : "it")});
    if (!(bound.lowest < bound.highest))
      faults.push_back({pointer, fmt::format("{} to {}: the lower bound must be below the upper",
                                             bound.lowest, bound.highest)});
  }
  if (!(options.noise.share >= 0.0) || !(options.noise.share_of_rms > 0.0))
    faults.push_back({"/noise", "the noise must be positive"});
  if (options.loss_scale && !(*options.loss_scale > 0.0))
    faults.push_back({"/loss_scale", fmt::format("loss_scale = {}, must be positive", *options.loss_scale)});
  return faults;
}

}  // namespace slipway::gap
