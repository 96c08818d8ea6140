#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "gap/diagnosis/model/hypothesis.h"
#include "gap/diagnosis/model/noise_model.h"
#include "gap/diagnosis/model/window_model.h"
#include "gap/diagnosis/search/discrepancy_term.h"
#include "gap/diagnosis/search/explanation.h"

namespace slipway::gap {

// What a variant of an effect, added to a fit, would bring by its derivatives there.
struct ScreenedEffect {
  std::size_t variant = 0;    // of those that were screened
  double gain = 0.0;          // of the logarithm of the evidence; far below 0 where the effect is in the fit
  std::vector<double> start;  // of the hypothesis with it: the estimate
  Eigen::VectorXd signature;  // whitened response of the estimate, the fit's own directions projected out
  double kept_share = 0.0;    // of the response's length that is left then
  double visibility = 0.0;    // length of what its first field's prior deviation does, likewise
  Eigen::MatrixXd reach;      // orthonormal: what its fields together could look like, whitened, likewise
  Eigen::MatrixXd columns;    // derivatives of every observation, by prior deviations
  // Of the fit's parameters, those whose own responses make up most of what the fit takes of the response,
  // the largest first.
  std::vector<std::size_t> taken_by;
};

// Every variant beside the fit, best first.
std::vector<ScreenedEffect> screen_effects(const DriveCampaign& campaign, const WindowModel& model,
                                           const NoiseModel& noise, const FittedExplanation& fit,
                                           const DiscrepancyTerm& discrepancy,
                                           std::span<const EffectVariant> variants,
                                           const DiscrepancyOptions& options, std::size_t threads);

}  // namespace slipway::gap
