#include "gap/diagnosis/search/parameter_posterior.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "gap/diagnosis/model/nuisance_catalogue.h"

namespace slipway::gap {
namespace {

bool of_sensors(std::string_view name) {
  const auto rows = nuisance_catalogue();
  return std::any_of(rows.begin(), rows.end(), [&](const Nuisance& row) {
    return row.kind == NuisanceKind::kSensor && row.name == name;
  });
}

}  // namespace

bool is_nuisance(std::string_view parameter, std::string_view nuisance, std::string_view soil) {
  return parameter == nuisance || parameter == fmt::format("{}/{}", nuisance, soil);
}

std::optional<std::size_t> ParameterPosterior::place_of(std::string_view nuisance,
                                                        std::string_view soil) const {
  const auto found = std::find_if(names.begin(), names.end(),
                                  [&](const std::string& name) { return is_nuisance(name, nuisance, soil); });
  if (found == names.end()) return std::nullopt;
  return static_cast<std::size_t>(found - names.begin());
}

double ParameterPosterior::deviation(std::size_t place) const {
  const auto p = static_cast<Eigen::Index>(place);
  return std::sqrt(covariance(p, p));
}

ParameterPosterior posterior_of(const FittedExplanation& fit) {
  const auto parameters = fit.hypothesis.parameters();
  std::vector<std::size_t> kept;
  for (std::size_t p = 0; p < parameters.size(); ++p)
    if (!of_sensors(parameters[p].name)) kept.push_back(p);
  ParameterPosterior posterior;
  const auto count = static_cast<Eigen::Index>(kept.size());
  posterior.covariance.resize(count, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const std::size_t a = kept[static_cast<std::size_t>(i)];
    posterior.names.push_back(parameters[a].name);
    for (Eigen::Index j = 0; j < count; ++j) {
      const std::size_t b = kept[static_cast<std::size_t>(j)];
      posterior.covariance(i, j) =
          fit.covariance(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b)) * parameters[a].std *
          parameters[b].std;
    }
  }
  return posterior;
}

void set_spread(const ParameterPosterior& posterior, const NoiseScales& scatter,
                sim::SoilDistribution& soil) {
  std::array<std::optional<std::size_t>, sim::kSoilDims> places;
  std::array<double, sim::kSoilDims> totals{scatter.stiffness, 0.0, 0.0, scatter.friction,
                                            scatter.shear_modulus};
  for (std::size_t q = 0; q < places.size(); ++q) {
    places[q] = posterior.place_of(kSoilNuisances[q], soil.name);
    if (places[q]) totals[q] = std::hypot(totals[q], posterior.deviation(*places[q]));
  }
  for (std::size_t a = 0; a < places.size(); ++a)
    for (std::size_t b = 0; b < places.size(); ++b)
      if (a != b && places[a] && places[b])
        soil.correlation(static_cast<int>(a), static_cast<int>(b)) =
            posterior.covariance(static_cast<Eigen::Index>(*places[a]),
                                 static_cast<Eigen::Index>(*places[b])) /
            (totals[a] * totals[b]);
  // No more than a soil's file may say.
  const auto share = [&](std::size_t quantity) { return std::min(totals[quantity], 1.0); };
  const double angle = soil.mean.friction_angle_rad;
  soil.std.stiffness_ratio = share(0);
  soil.std.n = std::min(0.5, soil.mean.pressure.n * share(1));
  soil.std.cohesion_pa = soil.mean.cohesion_pa * share(2);
  soil.std.friction_angle_rad = std::min(0.4, std::sin(angle) * std::cos(angle) * share(3));
  soil.std.shear_modulus_ratio = share(4);
}

}  // namespace slipway::gap
