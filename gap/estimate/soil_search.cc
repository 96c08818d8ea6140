#include "gap/estimate/soil_search.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/random.h"
#include "gap/estimate/soil_posterior.h"

namespace slipway::gap {

SoilSearch::SoilSearch(const SoilData& data, std::span<const sim::SoilDistribution> soils,
                       std::vector<FreeParameter> axes, const SoilEstimationOptions& options,
                       SoilObservations& observations, std::vector<double> deviations)
    : soils_(soils),
      options_(options),
      observations_(observations),
      deviations_(std::move(deviations)),
      rigs_(data, soils, observations.width_m(), std::move(axes)) {
  for (std::size_t k = 0; k < rigs_.axes().size(); ++k) unknowns_.push_back(unknown_of(k));
}

Unknown SoilSearch::unknown_of(std::size_t axis) const {
  const FreeParameter& parameter = rigs_.axes()[axis];
  Unknown u;
  u.name = parameter.shown();
  u.step_scale = rigs_.scale(axis);
  u.start = rigs_.start(axis);
  double lowest = rigs_.lowest(axis), highest = rigs_.highest(axis);
  for (const SoilBound& bound : options_.bounds)
    if (bound.parameter == parameter) {
      lowest = bound.lowest;
      highest = bound.highest;
    }
  u.lowest = rigs_.coordinate_of_value(axis, lowest);
  u.highest = rigs_.coordinate_of_value(axis, highest);
  u.start = std::clamp(u.start, u.lowest, u.highest);
  if (const auto std = prior_std(axis)) u.prior = Prior{u.start, *std};
  return u;
}

std::optional<double> SoilSearch::prior_std(std::size_t axis) const {
  if (axis < deviations_.size() && deviations_[axis] > 0.0) return deviations_[axis];
  if (options_.priors == SoilPriors::kNone) return std::nullopt;
  const auto soil = rigs_.soil_of(axis);
  const double own =
      options_.priors == SoilPriors::kSoil && soil ? own_spread(soils_[*soil], rigs_, axis) : 0.0;
  return own > 0.0 ? own : rigs_.wide_std(axis);
}

std::size_t SoilSearch::priors() const {
  return static_cast<std::size_t>(std::count_if(unknowns_.begin(), unknowns_.end(),
                                                [](const Unknown& u) { return u.prior.has_value(); }));
}

bool SoilSearch::predict(std::span<const double> x, std::span<double> values) const {
  std::vector<RigAt> rigs;
  rigs_.at(x, rigs);
  return observations_.predict(rigs, rigs_.soil_at(0, x), values);
}

ResidualFunction SoilSearch::residuals() const {
  return [this](std::span<const double> x, std::span<double> r) {
    if (!predict(x, r)) return false;
    const auto data = observations_.data();
    for (std::size_t i = 0; i < data.size(); ++i) r[i] = (r[i] - data[i].measured) / data[i].std;
    return true;
  };
}

// From elsewhere: what soils of all kinds differ by, half of it, and where n is another, k so that the
// pressure at a usual depth is the same.
std::vector<Unknown> SoilSearch::drawn_start(int start) const {
  std::vector<Unknown> moved = unknowns_;
  std::vector<double> exponent_change(rigs_.soils(), 0.0);
  for (std::size_t k = 0; k < moved.size(); ++k) {
    const double change = options_.start_share * rigs_.wide_std(k) *
                          random_normal(random_key(options_.seed, static_cast<std::uint64_t>(start)), k);
    if (rigs_.axes()[k].soil == SoilParameter::kN)
      for (std::size_t s = 0; s < rigs_.soils(); ++s)
        if (rigs_.applies_to_soil(k, s))
          exponent_change[s] =
              soils_[s].mean.pressure.n * (std::exp(moved[k].start + change) - std::exp(moved[k].start));
    moved[k].start += change;
  }
  for (std::size_t k = 0; k < moved.size(); ++k) {
    if (rigs_.axes()[k].soil == SoilParameter::kBekker)
      moved[k].start -= exponent_change[*rigs_.soil_of(k)] * std::log(options_.usual_depth_m);
    moved[k].start = std::clamp(moved[k].start, moved[k].lowest, moved[k].highest);
  }
  return moved;
}

Result<LeastSquaresFit> SoilSearch::fit(const LeastSquaresOptions& options, Progress& progress) const {
  Within within(progress);
  const std::size_t readings = observations_.data().size();
  const ResidualFunction residuals = this->residuals();
  auto best = fit_least_squares(unknowns_, readings, residuals, options, within);
  const auto is_poor = [&](const Result<LeastSquaresFit>& fit) {
    return !fit || !fit->converged || fit->residual_variance > options_.poor_variance;
  };
  for (int start = 1; start <= options_.further_starts && is_poor(best); ++start) {
    if (progress.cancelled()) break;
    auto fit = fit_least_squares(drawn_start(start), readings, residuals, options, within);
    if (fit && (!best || fit->cost < best->cost)) best = std::move(fit);
  }
  return best;
}

double own_spread(const sim::SoilDistribution& soil, const TestedRigs& rigs, std::size_t axis) {
  const FreeParameter& parameter = rigs.axes()[axis];
  if (parameter.soil) return coordinate_std(soil, *parameter.soil, rigs.soil_axes(*rigs.soil_of(axis)));
  if (parameter.name == "c1") return soil.std.c1;
  return parameter.name == "c2" ? soil.std.c2 : 0.0;
}

std::vector<Assumed> assumed_of(const SoilData& data, std::span<const sim::SoilDistribution> soils,
                                double width_m, std::span<const FreeParameter> free,
                                const SoilEstimationOptions& options) {
  std::vector<Assumed> assumed;
  if (data.wheels.empty()) return assumed;  // a plate's law has nothing else in it
  for (std::size_t s = 0; s < soils.size(); ++s) {
    const auto is_known = [&](std::string_view name) {
      const auto named = [&](const FreeParameter& p) {
        return p.name == name && (p.of.empty() || p.of == data.soil_label(s));
      };
      return std::any_of(free.begin(), free.end(), named) ||
             std::any_of(options.stated.begin(), options.stated.end(), named);
    };
    std::vector<FreeParameter> open;
    if (!is_known("k_bekker") && !is_known("k_c") && !is_known("k_phi"))
      open.emplace_back(SoilParameter::kBekker);
    for (const SoilParameter one :
         {SoilParameter::kN, SoilParameter::kCohesion, SoilParameter::kFrictionAngle})
      if (!is_known(row_of(one).name)) open.emplace_back(one);
    if (!is_known("shear_modulus") && !is_known("shear_modulus_x_m") && !is_known("shear_modulus_y_m"))
      open.emplace_back(SoilParameter::kShearModulus);
    for (const char* closure : {"c1", "c2"})
      if (!is_known(closure)) open.push_back(*free_parameter(closure));
    for (FreeParameter& parameter : open) parameter.of = data.soil_label(s);
    const TestedRigs rigs(data, soils, width_m, open);
    for (std::size_t k = 0; k < open.size(); ++k) {
      // Where nothing is believed of this soil, it is one of any kind.
      const bool own = options.priors == SoilPriors::kSoil || !open[k].soil;
      double std = own ? own_spread(soils[s], rigs, k) : rigs.wide_std(k);
      if (!open[k].soil && std == 0.0) std = kClosureSpread;
      if (std > 0.0) assumed.push_back({open[k], std});
    }
  }
  return assumed;
}

}  // namespace slipway::gap
