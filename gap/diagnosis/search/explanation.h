#pragma once

#include <Eigen/Core>
#include <span>
#include <string_view>
#include <vector>

#include "gap/diagnosis/model/hypothesis.h"
#include "gap/diagnosis/model/noise_model.h"
#include "gap/diagnosis/model/window_model.h"
#include "gap/diagnosis/search/diagnosis_options.h"
#include "gap/diagnosis/search/posterior_mode.h"

namespace slipway::gap {

// A hypothesis fitted to drives: the most probable parameters, and how probable the drives are under it with
// all its parameters averaged over their priors [Laplace's approximation].
struct FittedExplanation : PosteriorMode {
  Hypothesis hypothesis;
};

// Of two fits of one hypothesis the one with more evidence. A mode is the nearest to where its search began,
// so that what matters is fitted from more than one place.
void keep_better(FittedExplanation& fit, FittedExplanation other);

// Rows of `fitted_rows` alone weigh (empty: all). For `must_reach` see find_mode; it is not asked for where
// reference drives left open what adds to the evidence.
FittedExplanation fit_explanation(const Hypothesis& hypothesis, const WindowModel& model,
                                  const NoiseModel& noise, const ModeStart& start, const FitOptions& options,
                                  std::size_t threads, const std::vector<bool>& fitted_rows = {},
                                  double must_reach = kAnyEvidence);

// Where another fit found what both have, by name; what it does not have is neutral.
std::vector<double> started_at(const Hypothesis& hypothesis, const FittedExplanation& other);

// Derivatives of every observation, by prior deviations, of the effects that a hypothesis has more than a
// fit, at the fit's parameters, which `start` becomes with the added effects' neutral ones behind. The second
// are whitened, rows weighed as in the fit. `predicted`: what the fit predicts, of which the neutral effects
// change nothing; empty: not known yet.
Eigen::MatrixXd added_derivatives(const Hypothesis& hypothesis, const WindowModel& model,
                                  const FittedExplanation& fit, std::vector<double>& start,
                                  std::span<const double> predicted = {});
Eigen::MatrixXd added_columns(const Hypothesis& hypothesis, const WindowModel& model, const NoiseModel& noise,
                              const FittedExplanation& fit, std::vector<double>& start);

// How far an effect of a fit is from not being there, in prior deviations: of the field that went farthest,
// but for those that only say in which form it is at work.
double size_of(const FittedExplanation& fit, std::string_view effect);

// All observations as measured.
Eigen::VectorXd measured(const WindowModel& model);

// Whether what a fit re-tunes had to go so far from what was believed, in prior deviations.
bool went_far(const FittedExplanation& fit, double max_shift);

}  // namespace slipway::gap
