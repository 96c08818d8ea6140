#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/progress.h"
#include "core/result.h"

namespace slipway::gap {

// What was believed of an unknown before the data: one more residual, (x - mean) / std.
struct Prior {
  double mean = 0.0;
  double std = 1.0;
};

// A number to be estimated, in the caller's own unit.
struct Unknown {
  std::string name;    // unique; undetermined directions are reported by it
  double start = 0.0;  // within [lowest, highest]
  double lowest = -std::numeric_limits<double>::infinity();
  double highest = std::numeric_limits<double>::infinity();
  double step_scale = 1.0;  // a change of the unknown that matters, > 0: 0.1 for n, 1e6 for k_phi
  std::optional<Prior> prior;
};

// Fills the residuals at x, best in units of their standard deviations; false where the model has no answer
// there.
using ResidualFunction = std::function<bool(std::span<const double> x, std::span<double> residuals)>;

// What a residual r costs beyond 1/2 r^2, with s its scale [Huber 1964; Holland & Welsch 1977]:
//   none    1/2 r^2
//   huber   1/2 r^2 up to |r| = s, then s |r| - 1/2 s^2
//   cauchy  1/2 s^2 ln(1 + r^2 / s^2)
enum class RobustLoss { kNone, kHuber, kCauchy };
// "none", "huber", "cauchy".
std::span<const std::string_view> robust_loss_names();
// The scale at which, of normal residuals of standard deviation 1, an estimate is as good as with 95 % of
// them and no loss [Holland & Welsch 1977]: 1.345 for huber, 2.385 for cauchy; 1 for none, which has no
// scale.
double usual_loss_scale(RobustLoss loss);

struct LeastSquaresOptions {
  RobustLoss loss = RobustLoss::kNone;
  double loss_scale = 1.0;  // in the residuals' unit, > 0
  // Besides Unknown::start, this many less one are drawn: uniform between the bounds, or normal around the
  // start by step_scale where a bound is missing. The lowest cost wins, the earliest start among equals.
  int starts = 1;
  std::uint64_t seed = 1;
  int max_iterations = 200;
  double tolerance = 1e-12;  // relative change of the cost at which a search has converged, > 0
  // Step of the central differences, times max(|x|, step_scale). Leave it well above the relative noise of
  // the residuals: a model solved to 1e-9 wants 1e-4, not 1e-7.
  double relative_step = 1e-4;
  // A direction whose singular value is below this share of the largest is undetermined.
  double rank_tolerance = 1e-6;
  // True: residuals are in units of their standard deviations, and the covariance is (J^T J)^-1. False: their
  // common variance is estimated from what is left over, LeastSquaresFit::residual_variance.
  bool residual_std_known = true;
  // With known standard deviations: where residuals scatter more than those say, so that residual_variance is
  // above 1, residuals (not priors) count that much less in the covariance.
  bool widen = false;
  // False: covariance and what is undetermined are left empty, which saves a Jacobian.
  bool covariance = true;
};

// A combination of unknowns that the residuals and the priors say nothing about.
struct UndeterminedDirection {
  Eigen::VectorXd components;   // of length 1, unknowns counted in units of max(|x|, step_scale)
  double singular_value = 0.0;  // of the scaled Jacobian, over its largest
  std::string words;            // "0.71 k_c - 0.71 k_phi"
};

struct LeastSquaresFit {
  std::vector<double> estimate;
  double cost = 0.0;              // of residuals (through the loss) and priors; 1/2 sum r^2 without a loss
  std::vector<double> residuals;  // at the estimate, without priors and before the loss
  // What residuals and priors leave over per degree of freedom: sum r^2 / (residuals + priors - unknowns), to
  // be compared with 1 where the residuals are in units of their standard deviations. With a loss
  // [Huber 1981, section 7.6], of psi(r), its slope in r,
  //
  //   sum psi(r)^2 / (residuals + priors - unknowns) / mean of psi'(r)
  //
  // 0 where there are not more residuals than unknowns.
  double residual_variance = 0.0;
  // Through an SVD of the Jacobian of residuals and priors at the estimate, over the determined directions
  // alone. With a loss, residuals are weighted by psi'(r), and by 0 where that is negative: one that lies
  // beyond the scale of the loss says nothing of how sure the estimate is. An unknown on a bound is treated
  // as if it were free.
  Eigen::MatrixXd covariance;
  std::vector<UndeterminedDirection> undetermined;
  std::vector<bool> on_bound;
  bool converged = false;
  std::string message;  // how the best search ended, for people

  // Square root of the variance; nothing where the unknown takes part in an undetermined direction.
  std::optional<double> standard_error(std::size_t unknown) const;
  // Of two unknowns that both have a standard error above 0; nothing otherwise.
  std::optional<double> correlation(std::size_t a, std::size_t b) const;
};

// Levenberg-Marquardt with dense QR between bounds [Ceres Solver], central differences. Deterministic.
// Errors: invalid_request with the faults of unknowns and options ("/unknowns/1/lowest"); not_converged where
// the residuals have no value at any start; cancelled. A search that ran out of iterations is an answer with
// converged = false.
Result<LeastSquaresFit> fit_least_squares(std::span<const Unknown> unknowns, std::size_t residual_count,
                                          const ResidualFunction& residuals,
                                          const LeastSquaresOptions& options, Progress& progress);

}  // namespace slipway::gap
