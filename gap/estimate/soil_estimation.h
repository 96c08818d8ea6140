#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "core/progress.h"
#include "core/result.h"
#include "gap/estimate/soil_determination.h"
#include "gap/estimate/soil_estimation_options.h"
#include "gap/estimate/soil_observation.h"
#include "gap/estimate/soil_parameter.h"
#include "sim/soil/soil.h"

namespace slipway::gap {

// What is left over in one channel, in its unit and in deviations.
struct ChannelResidual {
  SoilChannel channel = SoilChannel::kTorque;
  std::size_t count = 0;
  double rms = 0.0, rms_deviations = 0.0;
};

struct FittedDatum {
  SoilDatum datum;
  double fitted = 0.0;
  bool outlier = false;  // beyond the loss's scale
};

// A combination of parameters, counted in deviations of what soils of all kinds have, that the data alone say
// less of than that.
struct OpenDirection {
  std::string words;   // "0.71 k_c - 0.71 n"
  double share = 0.0;  // of the deviation that the data leave open is 1 / share; 0: all of it
};

struct SoilEstimate {
  sim::SoilDistribution soil;  // posterior: mean, spread, correlation; its name and source are the nominal's
  std::vector<sim::SoilDistribution> further_soils;  // of tests in several soils: all but the first
  std::vector<EstimatedParameter> parameters;
  Eigen::MatrixXd correlation;  // of them, of what is searched (SoilAxes), in the order of `parameters`
  std::vector<OpenDirection> open;
  std::vector<ChannelResidual> channels;
  std::vector<FittedDatum> data;
  double width_m = 0.0;  // b of k_bekker
  // Of residuals in deviations, 1 where the readings scatter as their deviations say; where more, deviations
  // and intervals of the estimate are widened by its square root.
  double residual_variance = 0.0;
  double max_residual_variance = 0.0;  // beyond which the model does not hold (see DeterminationOptions)
  bool model_holds = true;
  std::size_t evaluations = 0;  // of the model for all data
  std::size_t sunk = 0;         // wheels that the estimated soil doesn't carry, held at the axle
  bool converged = false;
  std::vector<std::string> notes;
};

// The ARTEMIS paper's problem (section 3): the parameters of the soil at which the library's own laws meet
// what was measured, by Levenberg-Marquardt (least_squares.h) over TestedRigs from the nominal soils on, one
// for each of the data's.
//
// Errors: invalid_request with the faults of the options ("/free/1", "/bounds/0"); no_data with fewer
// readings than two; those of fit_least_squares.
Result<SoilEstimate> estimate_soils(std::span<const sim::SoilDistribution> nominals, const SoilData& data,
                                    const SoilEstimationOptions& options, Progress& progress);
// Of tests in one soil.
Result<SoilEstimate> estimate_soil(const sim::SoilDistribution& nominal, const SoilData& data,
                                   const SoilEstimationOptions& options, Progress& progress);

}  // namespace slipway::gap
