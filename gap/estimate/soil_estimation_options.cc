#include "gap/estimate/soil_estimation_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace slipway::gap {

bool holds(std::span<const SoilParameter> list, SoilParameter parameter) {
  return std::find(list.begin(), list.end(), parameter) != list.end();
}

std::optional<SoilPriors> soil_priors(std::string_view name) {
  if (name == "none") return SoilPriors::kNone;
  if (name == "wide") return SoilPriors::kWide;
  if (name == "soil") return SoilPriors::kSoil;
  return std::nullopt;
}

std::vector<SoilParameter> usual_free_parameters(const SoilData& data) {
  const SoilObservations observations(data, {}, {true, true, true, true, true, true});
  std::vector<SoilParameter> free;
  if (observations.one_width())
    free = {SoilParameter::kBekker, SoilParameter::kN};
  else
    free = {SoilParameter::kKc, SoilParameter::kKphi, SoilParameter::kN};
  if (!data.wheels.empty())
    free.insert(free.end(),
                {SoilParameter::kCohesion, SoilParameter::kFrictionAngle, SoilParameter::kShearModulus});
  return free;
}

std::vector<Fault> faults_of(std::span<const SoilParameter> free, const SoilEstimationOptions& options) {
  std::vector<Fault> faults;
  for (std::size_t i = 0; i < free.size(); ++i)
    if (std::count(free.begin(), free.begin() + static_cast<std::ptrdiff_t>(i), free[i]) > 0)
      faults.push_back(
          {fmt::format("/free/{}", i), fmt::format("{} is given more than once", row_of(free[i]).name)});
  const bool k_c = holds(free, SoilParameter::kKc), k_phi = holds(free, SoilParameter::kKphi);
  if (k_c != k_phi)
    faults.push_back({"/free", "k_c and k_phi are free together, or k_bekker in their place"});
  if (k_c && k_phi && holds(free, SoilParameter::kBekker))
    faults.push_back({"/free", "k_bekker stands for k_c and k_phi: give it or them"});
  for (std::size_t i = 0; i < options.bounds.size(); ++i) {
    const SoilBound& bound = options.bounds[i];
    const std::string pointer = fmt::format("/bounds/{}", i);
    if (!holds(free, bound.parameter))
      faults.push_back({pointer, fmt::format("{} is not free", row_of(bound.parameter).name)});
    else if (bound.parameter == SoilParameter::kKphi)
      faults.push_back({pointer, "k_phi follows from k_c and the stiffness: bound k_c"});
    // Beyond what a soil's file may hold, the estimate could not be read back.
    const SoilParameterRow& row = row_of(bound.parameter);
    const Field field = row.field ? row.field->field : Field{"k_bekker", row.unit, "", 1e-6, 1e11};
    for (const double value : {bound.lowest, bound.highest})
      if (const double shown = row.boundary_unit * value, near = 1e-12 * std::abs(shown);
          shown < field.lowest - near || shown > field.highest + near)
        faults.push_back(
            {pointer, fmt::format("{} = {:g}, must be in [{:g}, {:g}], which a soil's file holds", row.name,
                                  shown, field.lowest, field.highest)});
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
