#include "gap/diagnosis/search/posterior_mode.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace slipway::gap {
namespace {

// While an iteration lowers the cost by more than this, one-sided derivatives do. It decides only how much
// work is done.
constexpr double kNear = 1.0;
// Passes of the active set; each holds at least one parameter more, and more than two are rarely needed.
constexpr int kMaxPasses = 4;

bool is_fitted(const std::vector<bool>& fitted_rows, Eigen::Index row) {
  return fitted_rows.empty() || fitted_rows[static_cast<std::size_t>(row)];
}

// A point that was tried, with what the model says there.
struct Trial {
  std::vector<double> x, predicted;
  Eigen::VectorXd residuals, white, u;
  double cost = 0.0;
  int unanswered = 0;
};

class ModeSearch {
 public:
  ModeSearch(const FittedModel& model, const FitOptions& options, const std::vector<bool>& fitted_rows,
             double must_reach)
      : model_(model),
        options_(options),
        fitted_rows_(fitted_rows),
        must_reach_(must_reach),
        loss_{options.huber},
        precision_(model.prior_precision()) {}

  PosteriorMode run(const ModeStart& start) {
    at_ = trial_at({start.x.begin(), start.x.end()});
    if (start.jacobian != nullptr) take_known(start);
    for (int iteration = 0;; ++iteration) {
      const bool given_up = is_too_slow(options_.max_iterations - iteration);
      const bool last = given_up || converged_ || iteration >= options_.max_iterations || model_.cancelled();
      if (!given_up) linearise(last);
      weights_ = loss_weights(at_.white, loss_, fitted_rows_);
      NormalEquations equations = normal_equations(columns_, weights_, precision_);
      covariance_ = std::move(equations.covariance);
      if (last || !improve(equations)) break;
    }
    return answer();
  }

 private:
  Trial trial_at(std::vector<double> x) const {
    Trial trial;
    trial.x = std::move(x);
    trial.predicted = model_.predict(trial.x);
    const Eigen::VectorXd& y = model_.measured();
    trial.residuals.resize(y.size());
    for (Eigen::Index i = 0; i < y.size(); ++i) {
      const double f = trial.predicted[static_cast<std::size_t>(i)];
      trial.residuals[i] = std::isfinite(f) ? y[i] - f : without_answer(i) * model_.deviation()[i];
    }
    trial.unanswered = unanswered_rows(model_, trial.predicted, fitted_rows_);
    trial.white = model_.whiten(trial.residuals);
    trial.u = in_prior_units(model_.parameters(), trial.x);
    trial.cost = negative_log_posterior(trial.white, trial.u, loss_, fitted_rows_, precision_);
    return trial;
  }

  // Whether so many iterations more, in each of which the cost falls by the larger of its last two falls,
  // would not do: the log evidence is hardly above the cost's negative. What is near its mode is finished.
  bool is_too_slow(int iterations_left) const {
    return !near_ && iterations_left * std::max(fall_, fall_before_) < must_reach_ + at_.cost;
  }

  // Deviations by which a row is off where the model has no answer.
  double without_answer(Eigen::Index row) const {
    return model_.stood(row) ? options_.both_stuck : options_.no_answer;
  }

  void take_known(const ModeStart& start) {
    jacobian_ = *start.jacobian;
    const bool here = std::equal(start.x.begin(), start.x.end(), start.known_at.begin());
    central_ = fresh_ = here && start.central;
    if (!here)
      follow(at_.u - in_prior_units(model_.parameters(), start.known_at), *start.residuals - at_.residuals);
    columns_ = model_.whiten(jacobian_);
  }

  // The derivatives after a step in u by which predictions changed so much: as before across the step, as
  // seen along it. Rows without derivatives have no answer at one of the two points.
  void follow(const Eigen::VectorXd& step, const Eigen::VectorXd& change) {
    const double square = step.squaredNorm();
    if (square == 0.0) return;
    Eigen::VectorXd unseen = (change - jacobian_ * step) / square;
    for (Eigen::Index i = 0; i < unseen.size(); ++i)
      if (jacobian_.row(i).isZero(0.0)) unseen[i] = 0.0;
    jacobian_ += unseen * step.transpose();
  }

  // Near the answer by central differences, once: from there on they hardly change.
  void linearise(bool last) {
    const bool central = near_ || last;
    if (central ? central_ : jacobian_.size() > 0) return;
    central_ = central;
    fresh_ = true;
    jacobian_ = model_.scaled_jacobian(at_.x, central_ ? std::span<const double>{} : at_.predicted);
    columns_ = model_.whiten(jacobian_);
  }

  // One step. Whether to go on: not, where no step lowers the cost although the derivatives are those of
  // here.
  bool improve(const NormalEquations& equations) {
    const auto parameters = model_.parameters();
    const auto count = static_cast<Eigen::Index>(parameters.size());
    // r(x + J du) = r - J du.
    Eigen::VectorXd gradient = equations.weighted.transpose() * at_.white;
    if (precision_.size() == 0)
      gradient -= at_.u;
    else
      gradient -= precision_ * at_.u;
    Eigen::VectorXd low(count), high(count);
    for (Eigen::Index p = 0; p < count; ++p) {
      const Parameter& parameter = parameters[static_cast<std::size_t>(p)];
      low[p] = (parameter.lowest - parameter.neutral) / parameter.std - at_.u[p];
      high[p] = (parameter.highest - parameter.neutral) / parameter.std - at_.u[p];
    }
    const Eigen::VectorXd step = bounded_step(equations.hessian, gradient, low, high);
    double largest = 0.0;  // in the parameters' own standard errors
    for (Eigen::Index p = 0; p < count; ++p)
      largest = std::max(largest, std::abs(step[p]) / std::sqrt(covariance_(p, p)));
    Trial trial;
    const auto cost_at = [&](double share) {
      std::vector<double> x(at_.x.size());
      for (std::size_t p = 0; p < x.size(); ++p)
        x[p] = std::clamp(at_.x[p] + share * step[static_cast<Eigen::Index>(p)] * parameters[p].std,
                          parameters[p].lowest, parameters[p].highest);
      trial = trial_at(std::move(x));
      return trial.cost;
    };
    const auto answers = [&] { return trial.unanswered <= at_.unanswered; };
    if (const auto share = shortened_step(at_.cost, cost_at, answers, [&] { return model_.cancelled(); })) {
      fall_before_ = std::exchange(fall_, at_.cost - trial.cost);
      converged_ = fall_ < options_.min_fall || *share * largest < options_.tolerance;
      near_ = fall_ < kNear;
      fresh_ = false;
      if (!near_) {
        central_ = false;
        follow(trial.u - at_.u, at_.residuals - trial.residuals);
        columns_ = model_.whiten(jacobian_);
      }
      at_ = std::move(trial);
      return true;
    }
    converged_ = near_ && fresh_;
    if (converged_) return false;
    near_ = true;
    central_ = central_ && fresh_;
    return true;
  }

  PosteriorMode answer() {
    PosteriorMode mode;
    mode.row_weights = weights_.cwiseSqrt();
    mode.white_jacobian = mode.row_weights.asDiagonal() * columns_;
    mode.white_linear = mode.row_weights.asDiagonal() * (at_.white + columns_ * at_.u);
    if (precision_.size() > 0)
      mode.white_jacobian *= prior_root(precision_);
    else
      mode.held = held();
    mode.log_evidence = laplace_log_evidence(at_.cost, covariance_, model_.parameters(), precision_);
    mode.x = std::move(at_.x);
    mode.residuals = std::move(at_.residuals);
    mode.jacobian = std::move(jacobian_);
    mode.covariance = std::move(covariance_);
    mode.converged = converged_;
    mode.central = central_;
    mode.unanswered = at_.unanswered;
    return mode;
  }

  std::vector<std::pair<Eigen::Index, double>> held() const {
    const auto parameters = model_.parameters();
    const Eigen::VectorXd towards = columns_.transpose() * weights_.cwiseProduct(at_.white) - at_.u;
    std::vector<std::pair<Eigen::Index, double>> found;
    for (std::size_t p = 0; p < parameters.size(); ++p) {
      const auto i = static_cast<Eigen::Index>(p);
      const double rounding = 1e-9 * parameters[p].std;
      if ((at_.x[p] <= parameters[p].lowest + rounding && towards[i] < 0.0) ||
          (at_.x[p] >= parameters[p].highest - rounding && towards[i] > 0.0))
        found.emplace_back(i, at_.u[i]);
    }
    return found;
  }

  const FittedModel& model_;
  const FitOptions& options_;
  const std::vector<bool>& fitted_rows_;
  double must_reach_;
  HuberLoss loss_;
  Eigen::MatrixXd precision_;  // of the prior; empty: 1
  Trial at_;
  Eigen::MatrixXd jacobian_, columns_;  // columns_: whitened
  Eigen::VectorXd weights_;
  Eigen::MatrixXd covariance_;
  // Of the cost in the last two steps; infinite before there were any.
  double fall_ = std::numeric_limits<double>::infinity(), fall_before_ = fall_;
  // near_: the last step hardly lowered the cost; central_: the derivatives are central differences; fresh_:
  // they were taken at this very point.
  bool near_ = false, central_ = false, fresh_ = false, converged_ = false;
};

LinearProblem without_held(LinearProblem problem, const PosteriorMode& mode) {
  for (const auto& [parameter, u] : mode.held) {
    problem.residuals -= u * problem.columns.col(parameter);
    problem.columns.col(parameter).setZero();
  }
  return problem;
}

}  // namespace

int unanswered_rows(const FittedModel& model, std::span<const double> predicted,
                    const std::vector<bool>& fitted_rows) {
  int count = 0;
  for (Eigen::Index i = 0; i < static_cast<Eigen::Index>(predicted.size()); ++i)
    if (!std::isfinite(predicted[static_cast<std::size_t>(i)]) && !model.stood(i) &&
        model.deviation()[i] > 0.0 && is_fitted(fitted_rows, i))
      ++count;
  return count;
}

Eigen::VectorXd in_prior_units(std::span<const Parameter> parameters, std::span<const double> x) {
  Eigen::VectorXd u(static_cast<Eigen::Index>(x.size()));
  for (std::size_t p = 0; p < x.size(); ++p)
    u[static_cast<Eigen::Index>(p)] = (x[p] - parameters[p].neutral) / parameters[p].std;
  return u;
}

Eigen::VectorXd loss_weights(const Eigen::VectorXd& white, const HuberLoss& loss,
                             const std::vector<bool>& fitted_rows) {
  Eigen::VectorXd weights = Eigen::VectorXd::Ones(white.size());
  for (Eigen::Index i = 0; i < white.size(); ++i)
    weights[i] = is_fitted(fitted_rows, i) ? loss.weight(white[i]) : 0.0;
  return weights;
}

double negative_log_posterior(const Eigen::VectorXd& white, const Eigen::VectorXd& u, const HuberLoss& loss,
                              const std::vector<bool>& fitted_rows, const Eigen::MatrixXd& precision) {
  double cost = 0.5 * (precision.size() == 0 ? u.squaredNorm() : u.dot(precision * u));
  for (Eigen::Index i = 0; i < white.size(); ++i)
    if (is_fitted(fitted_rows, i)) cost += loss(white[i]);
  return cost;
}

NormalEquations normal_equations(const Eigen::MatrixXd& columns, const Eigen::VectorXd& weights,
                                 const Eigen::MatrixXd& precision) {
  NormalEquations equations;
  equations.weighted = weights.asDiagonal() * columns;
  equations.hessian = equations.weighted.transpose() * columns;
  if (precision.size() == 0)
    equations.hessian.diagonal().array() += 1.0;
  else
    equations.hessian += precision;
  const Eigen::LLT<Eigen::MatrixXd> llt(equations.hessian);
  equations.covariance = llt.solve(Eigen::MatrixXd::Identity(columns.cols(), columns.cols()));
  return equations;
}

Eigen::MatrixXd prior_root(const Eigen::MatrixXd& precision) {
  const Eigen::LLT<Eigen::MatrixXd> llt(precision);
  return llt.matrixU().solve(Eigen::MatrixXd::Identity(precision.rows(), precision.cols()));
}

Eigen::VectorXd bounded_step(const Eigen::MatrixXd& hessian, const Eigen::VectorXd& gradient,
                             const Eigen::VectorXd& low, const Eigen::VectorXd& high) {
  const Eigen::Index count = gradient.size();
  Eigen::VectorXd step = Eigen::VectorXd::Zero(count);
  std::vector<bool> held(static_cast<std::size_t>(count), false);
  for (int pass = 0; pass < kMaxPasses; ++pass) {
    std::vector<Eigen::Index> free;
    for (Eigen::Index p = 0; p < count; ++p)
      if (!held[static_cast<std::size_t>(p)]) free.push_back(p);
    // Held ones are at their bounds: their part of the step is known.
    Eigen::VectorXd g = gradient;
    for (Eigen::Index p = 0; p < count; ++p)
      if (held[static_cast<std::size_t>(p)]) g -= hessian.col(p) * step[p];
    const Eigen::MatrixXd sub = hessian(free, free);
    const Eigen::VectorXd solved = sub.llt().solve(Eigen::VectorXd(g(free)));
    bool crossed = false;
    for (std::size_t i = 0; i < free.size(); ++i) {
      const Eigen::Index p = free[i];
      step[p] = solved[static_cast<Eigen::Index>(i)];
      if (!(step[p] < low[p] || step[p] > high[p])) continue;
      step[p] = std::clamp(step[p], low[p], high[p]);
      held[static_cast<std::size_t>(p)] = true;
      crossed = true;
    }
    if (!crossed) break;
  }
  return step;
}

double laplace_log_evidence(double cost, const Eigen::MatrixXd& covariance,
                            std::span<const Parameter> parameters, const Eigen::MatrixXd& precision) {
  const Eigen::LLT<Eigen::MatrixXd> llt(covariance);
  double log_evidence = -cost + llt.matrixLLT().diagonal().array().log().sum();
  if (precision.size() > 0)
    log_evidence += Eigen::LLT<Eigen::MatrixXd>(precision).matrixLLT().diagonal().array().log().sum();
  for (const Parameter& parameter : parameters)
    if (!parameter.effect.empty() &&
        (parameter.lowest == parameter.neutral || parameter.highest == parameter.neutral))
      log_evidence += std::log(2.0);
  return log_evidence;
}

LinearProblem linear_problem(const PosteriorMode& mode) {
  return without_held({mode.white_linear, mode.white_jacobian}, mode);
}

LinearProblem unwhitened_problem(const PosteriorMode& mode, std::span<const Parameter> parameters) {
  return without_held({mode.residuals + mode.jacobian * in_prior_units(parameters, mode.x), mode.jacobian},
                      mode);
}

PosteriorMode find_mode(const FittedModel& model, const ModeStart& start, const FitOptions& options,
                        const std::vector<bool>& fitted_rows, double must_reach) {
  return ModeSearch(model, options, fitted_rows, must_reach).run(start);
}

}  // namespace slipway::gap
