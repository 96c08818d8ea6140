#pragma once

#include <Eigen/Core>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "gap/diagnosis/model/hypothesis.h"
#include "gap/diagnosis/search/diagnosis_options.h"
#include "gap/diagnosis/search/huber_loss.h"

namespace slipway::gap {

// The most probable parameters of a model under normal priors that are cut at bounds, with residuals that are
// normal at their centre and heavy-tailed (Huber's loss), and Laplace's approximation of the evidence there.
//
// With u = (x - neutral) / prior deviation and w = W (y - f(x)) the whitened residuals (block_whitening.h),
// the cost is
//
//   J(u) = sum_i loss(w_i) + u^T u / 2,
//
// the negative logarithm of posterior density up to a constant. It is lowered by Gauss-Newton steps with
// reweighted rows: linearise, step within the bounds, halve the step until the cost falls. On the way
// derivatives follow the steps by rank-one updates [Broyden 1965]; near the mode they are taken anew.

// What the mode is searched of: predictions, their derivatives, and the noise's whitening.
class FittedModel {
 public:
  virtual ~FittedModel() = default;
  virtual std::span<const Parameter> parameters() const = 0;
  virtual const Eigen::VectorXd& measured() const = 0;
  // Of every observation; NaN where the model has no answer.
  virtual std::vector<double> predict(std::span<const double> x) const = 0;
  // Columns of derivatives of the predictions, times the parameters' prior deviations. With what is
  // `predicted` at x one-sided, which costs half; without (empty) central.
  virtual Eigen::MatrixXd scaled_jacobian(std::span<const double> x,
                                          std::span<const double> predicted) const = 0;
  virtual Eigen::MatrixXd whiten(const Eigen::MatrixXd& columns) const = 0;  // W columns
  virtual const Eigen::VectorXd& deviation() const = 0;                      // of each observation's noise
  virtual bool cancelled() const = 0;
  // Whether a row was measured where the rover hardly moved, as a model says that has no answer there.
  virtual bool stood(Eigen::Index) const { return false; }
  // Of the prior of u; empty: the unit matrix.
  virtual Eigen::MatrixXd prior_precision() const { return {}; }
};

struct PosteriorMode {
  std::vector<double> x;
  Eigen::VectorXd residuals;  // measured less predicted at x; where there is no answer, see FitOptions
  // Whitened, rows of outliers weighed down: residuals with what the parameters explain put back, and columns
  // of prior deviation 1; behind them those of what reference drives left open.
  Eigen::VectorXd white_linear;
  Eigen::MatrixXd white_jacobian;
  Eigen::VectorXd row_weights;  // square roots of the loss's weights
  Eigen::MatrixXd jacobian;     // columns times the prior deviations, at x
  Eigen::MatrixXd covariance;   // of (x - neutral) over the prior deviations
  double log_evidence = 0.0;    // of the drives, up to a constant common to all explanations
  bool converged = false;
  bool central = false;  // `jacobian` has central differences
  int unanswered = 0;    // see unanswered_rows
  // Parameters that a bound holds where the drives would move them beyond it, with their u. Not told with a
  // prior precision, whose directions mix what is re-tuned.
  std::vector<std::pair<Eigen::Index, double>> held;
};

// The whitened linear problem around a mode in which held parameters stay where they are: their part of the
// predictions is not put back into the residuals, and their columns are 0. A linear problem in which they
// could go on would explain by them what only an effect can.
struct LinearProblem {
  Eigen::VectorXd residuals;
  Eigen::MatrixXd columns;
};
LinearProblem linear_problem(const PosteriorMode& mode);
// The same in the observations' own units, rows not weighed, without what reference drives left open.
LinearProblem unwhitened_problem(const PosteriorMode& mode, std::span<const Parameter> parameters);

// What a log evidence has to come to where anything will do.
constexpr double kAnyEvidence = -std::numeric_limits<double>::infinity();

// Where a search begins, and the derivatives that are known already at a point nearby: with a fit under
// another noise those of that very point, with an effect more those of the fit without it. They save the
// first derivatives, and all of them where the mode turns out to be near a point of central ones.
struct ModeStart {
  ModeStart(std::span<const double> start) : x(start) {}     // NOLINT(google-explicit-constructor)
  ModeStart(const std::vector<double>& start) : x(start) {}  // NOLINT(google-explicit-constructor)
  ModeStart(std::span<const double> start, std::span<const double> at, const Eigen::VectorXd& left,
            const Eigen::MatrixXd& derivatives)
      : x(start), known_at(at), residuals(&left), jacobian(&derivatives) {}
  // A mode of the same model, perhaps under another noise.
  static ModeStart at(const PosteriorMode& mode) {
    ModeStart start(mode.x, mode.x, mode.residuals, mode.jacobian);
    start.central = mode.central;
    return start;
  }

  std::span<const double> x;
  std::span<const double> known_at;  // empty: no derivatives are known
  const Eigen::VectorXd* residuals = nullptr;
  const Eigen::MatrixXd* jacobian = nullptr;
  bool central = false;
};

// The mode nearest to `start`. Rows of `fitted_rows` alone weigh (empty: all). Where the cost falls too
// slowly for the log evidence to come to `must_reach` in the iterations that are left, it is a point on the
// way.
PosteriorMode find_mode(const FittedModel& model, const ModeStart& start, const FitOptions& options,
                        const std::vector<bool>& fitted_rows = {}, double must_reach = kAnyEvidence);

// The parts of it.

// Of what a model predicts, the fitted rows in which it has no answer though the rover drove on.
int unanswered_rows(const FittedModel& model, std::span<const double> predicted,
                    const std::vector<bool>& fitted_rows);

// u of x.
Eigen::VectorXd in_prior_units(std::span<const Parameter> parameters, std::span<const double> x);

// The loss's weight of every whitened residual; 0 of rows that are not fitted.
Eigen::VectorXd loss_weights(const Eigen::VectorXd& white, const HuberLoss& loss,
                             const std::vector<bool>& fitted_rows);

// J(u), with u^T P u / 2 where the prior has a precision P.
double negative_log_posterior(const Eigen::VectorXd& white, const Eigen::VectorXd& u, const HuberLoss& loss,
                              const std::vector<bool>& fitted_rows, const Eigen::MatrixXd& precision = {});

// The normal equations of whitened columns A with row weights W: H = A^T W A + P, C = H^-1; P = 1 where it is
// not given.
struct NormalEquations {
  Eigen::MatrixXd weighted;  // W A
  Eigen::MatrixXd hessian, covariance;
};
NormalEquations normal_equations(const Eigen::MatrixXd& columns, const Eigen::VectorXd& weights,
                                 const Eigen::MatrixXd& precision = {});

// R with R R^T = P^-1, so that u = R v and v is of deviation 1 in every direction. P must not be empty.
Eigen::MatrixXd prior_root(const Eigen::MatrixXd& precision);

// The step s that minimises s^T H s / 2 - g^T s with what would cross a bound held there: the active set
// grows by what crosses, in a few passes. `low` and `high`: of the step.
Eigen::VectorXd bounded_step(const Eigen::MatrixXd& hessian, const Eigen::VectorXd& gradient,
                             const Eigen::VectorXd& low, const Eigen::VectorXd& high);

// The largest share 1, 1/2, 1/4, 1/8, 1/16 of a step at which `cost_at` is below `cost` and what was tried
// `answers` as many rows as before; without such a share the largest that lowers the cost; none where no
// share does or the work is cancelled. Beyond the slope that a rover climbs a model has no answer and no
// derivatives, so that a fit that steps there does not find back. `cost_at` was called last with the answer.
template <class CostAt, class Answers, class Cancelled>
std::optional<double> shortened_step(double cost, const CostAt& cost_at, const Answers& answers,
                                     const Cancelled& cancelled) {
  std::optional<double> lower;
  for (double share = 1.0; share > 0.05 && !cancelled(); share *= 0.5) {
    if (cost_at(share) >= cost) continue;
    if (answers()) return share;
    if (!lower) lower = share;
  }
  if (lower) cost_at(*lower);
  return lower;
}

// Laplace's approximation: the logarithm of the integral of exp(-J) over u with the prior's constant, by the
// curvature at the mode, -J + log |C| / 2 + log |P| / 2. A prior of an effect that is cut at its neutral
// value is twice as dense on its one side.
double laplace_log_evidence(double cost, const Eigen::MatrixXd& covariance,
                            std::span<const Parameter> parameters, const Eigen::MatrixXd& precision = {});

}  // namespace slipway::gap
