#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gap/diagnosis/model/hypothesis.h"
#include "gap/diagnosis/model/noise_model.h"
#include "gap/diagnosis/model/window_model.h"

namespace slipway::gap {

// A hypothesis fitted to drives: the most probable parameters, and how probable the drives are under it with
// all its parameters averaged over their priors [Laplace's approximation].
struct FittedExplanation {
  Hypothesis hypothesis;
  std::vector<double> x;
  Eigen::VectorXd residuals;  // measured less predicted at x; 0 where there is no answer or not used
  // Whitened, rows of outliers shrunk: residuals with what the parameters explain put back, and columns.
  Eigen::VectorXd white_linear;
  Eigen::MatrixXd white_jacobian;
  Eigen::VectorXd row_weights;  // square roots of the loss's weights
  Eigen::MatrixXd jacobian;     // columns times the prior deviations, at x
  Eigen::MatrixXd covariance;   // of (x - neutral) over the prior deviations
  double log_evidence = 0.0;    // of the drives, up to a constant common to all explanations
  bool converged = false;
};

struct ExplanationOptions {
  int iterations = 12;
  double tolerance = 1e-3;  // of a step, in the parameters' own standard errors
  double huber = 4.0;       // in deviations
  std::size_t threads = 0;
};

// Rows of `fitted_rows` alone weigh (empty: all).
FittedExplanation fit_explanation(const Hypothesis& hypothesis, const WindowModel& model,
                                  const NoiseModel& noise, std::span<const double> start,
                                  const ExplanationOptions& options,
                                  const std::vector<bool>& fitted_rows = {});

// The whitened columns, by prior deviations, of the effects that a hypothesis has more than a fit, at the
// fit's parameters, which `start` becomes with the added effects' neutral ones behind.
Eigen::MatrixXd added_columns(const Hypothesis& hypothesis, const WindowModel& model, const NoiseModel& noise,
                              const FittedExplanation& fit, std::vector<double>& start);

// How far an effect of a fit is from not being there, in prior deviations: of the field that went farthest.
double size_of(const FittedExplanation& fit, std::string_view effect);

// All observations as measured.
Eigen::VectorXd measured(const WindowModel& model);

}  // namespace slipway::gap
