#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gap/diagnosis/model/noise_model.h"
#include "gap/diagnosis/model/nuisance_catalogue.h"
#include "gap/diagnosis/search/explanation.h"
#include "sim/soil/soil.h"

namespace slipway::gap {

// Whether a parameter of a hypothesis is this nuisance of this soil ("friction/sand"), or of the campaign's
// only one ("friction").
bool is_nuisance(std::string_view parameter, std::string_view nuisance, std::string_view soil);

// What a fit leaves open of rover, soils, closures and effects; errors of the campaign's own sensors left
// out.
struct ParameterPosterior {
  std::vector<std::string> names;  // as Hypothesis::parameters: "friction/sand", "grousers.height_m"
  Eigen::MatrixXd covariance;      // in the parameters' own units

  // The place of a nuisance, see is_nuisance.
  std::optional<std::size_t> place_of(std::string_view nuisance, std::string_view soil) const;
  double deviation(std::size_t place) const;
};

// The covariance of Laplace's approximation, priors included.
ParameterPosterior posterior_of(const FittedExplanation& fit);

// The soil's spread: what the estimate leaves open, and what differs from drive to drive.
void set_spread(const ParameterPosterior& posterior, const NoiseScales& scatter, sim::SoilDistribution& soil);

}  // namespace slipway::gap
