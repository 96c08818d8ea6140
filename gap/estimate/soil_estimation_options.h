#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "gap/estimate/free_parameter.h"
#include "gap/estimate/least_squares.h"
#include "gap/estimate/soil_determination.h"
#include "gap/estimate/soil_observation.h"
#include "gap/estimate/soil_parameter.h"

namespace slipway::gap {

// What is believed of the soil before the data, around the nominal one:
enum class SoilPriors {
  kNone,
  kWide,  // SoilParameterRow::wide_std, what soils of all kinds have
  kSoil,  // the nominal soil's own spread; wide where it gives none
};
std::optional<SoilPriors> soil_priors(std::string_view name);  // "none", "wide", "soil"

// A bound that is not the row's own, in SI and radians, or in the boundary's unit of what is none of the
// seven.
struct SoilBound {
  FreeParameter parameter = SoilParameter::kN;
  double lowest = 0.0, highest = 0.0;
};

struct SoilEstimationOptions {
  std::vector<FreeParameter> free = {};  // empty: usual_free_parameters
  // What is not free and yet known, as it was given for these tests; all else is assumed as far as a verdict
  // goes (see DeterminationGrounds).
  std::vector<FreeParameter> stated = {};
  SoilPriors priors = SoilPriors::kWide;
  std::vector<SoilBound> bounds = {};
  std::array<bool, kSoilChannels> channels{true, true, true, true, true, true, true};
  ReadingNoise noise = {};
  RobustLoss loss = RobustLoss::kNone;
  std::optional<double> loss_scale = {};  // in deviations; nothing: usual_loss_scale()
  // Searches from elsewhere between the bounds where the first does not converge or leaves residuals of more
  // than `poor_variance` in deviations: twice the noise.
  int further_starts = 12;
  double poor_variance = 4.0;
  // Further starts are drawn with this share of what soils of all kinds differ by; where n is another, k is
  // so that the pressure at a usual depth of sinkage stays.
  double start_share = 0.5;
  double usual_depth_m = 0.03;
  double outlier_scales = 2.0;   // of the loss: readings beyond are counted as outliers
  std::size_t min_readings = 2;  // fewer are refused
  DeterminationOptions determination = {};
  bool profile = true;  // 90 % intervals by profile likelihood; otherwise from the covariance
  std::uint64_t seed = 1;
};

// Those that such data can say: k_bekker, or k_c and k_phi where widths differ, and n; with wheels cohesion,
// friction angle and shear modulus too.
std::vector<FreeParameter> usual_free_parameters(const SoilData& data);

bool holds(std::span<const FreeParameter> list, const FreeParameter& parameter);

// What is wrong with the options for these free parameters of such data: "/free/1", "/bounds/0", "/noise",
// "/loss_scale".
std::vector<Fault> faults_of(std::span<const FreeParameter> free, const SoilData& data,
                             const SoilEstimationOptions& options);

}  // namespace slipway::gap
