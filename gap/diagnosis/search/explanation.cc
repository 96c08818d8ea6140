#include "gap/diagnosis/search/explanation.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "core/parallel_for.h"

namespace slipway::gap {
namespace {

// An observation that the model has no answer to, because the rover would not move, is this far off.
constexpr double kNoAnswer = 4.0;  // deviations

Eigen::VectorXd residuals_of(std::span<const double> predicted, const NoiseModel& noise,
                             const Eigen::VectorXd& y) {
  Eigen::VectorXd r(y.size());
  for (Eigen::Index i = 0; i < y.size(); ++i) {
    const double f = predicted[static_cast<std::size_t>(i)];
    r[i] = std::isfinite(f) ? y[i] - f : kNoAnswer * noise.deviation()[i];
  }
  return r;
}

// Of the cost, by an iteration: less is no progress.
constexpr double kLeastFall = 0.02;
// While an iteration lowers the cost by more than this, one-sided derivatives do.
constexpr double kNear = 1.0;

// The null's parameters with an effect's neutral ones behind.
std::vector<double> extended(const Hypothesis& hypothesis, std::span<const double> x) {
  std::vector<double> start = hypothesis.neutral();
  std::copy(x.begin(), x.end(), start.begin());
  return start;
}

}  // namespace

Eigen::MatrixXd added_columns(const Hypothesis& hypothesis, const WindowModel& model, const NoiseModel& noise,
                              const FittedExplanation& fit, std::vector<double>& start) {
  start = extended(hypothesis, fit.x);
  const auto parameters = hypothesis.parameters();
  const std::size_t from = fit.x.size();
  const auto rows = static_cast<Eigen::Index>(model.observation_count());
  Eigen::MatrixXd columns(rows, static_cast<Eigen::Index>(parameters.size() - from));
  const std::vector<double> at = hypothesis.predict(model, start);
  for (std::size_t p = from; p < parameters.size(); ++p) {
    const Parameter& parameter = parameters[p];
    std::vector<double> x = start;
    const double step = hypothesis.step(p);
    x[p] = x[p] + step <= parameter.highest ? x[p] + step : x[p] - step;
    const std::vector<double> changed = hypothesis.predict(model, x);
    const double scale = parameter.std / (x[p] - start[p]);
    for (Eigen::Index i = 0; i < rows; ++i) {
      const double slope = scale * (changed[static_cast<std::size_t>(i)] - at[static_cast<std::size_t>(i)]);
      columns(i, static_cast<Eigen::Index>(p - from)) = std::isfinite(slope) ? slope : 0.0;
    }
  }
  return fit.row_weights.asDiagonal() * noise.whiten(columns);
}

double size_of(const FittedExplanation& fit, std::string_view effect) {
  const auto parameters = fit.hypothesis.parameters();
  double size = 0.0;
  for (std::size_t p = fit.hypothesis.nuisance_count(); p < parameters.size(); ++p)
    if (parameters[p].effect == effect)
      size = std::max(size, std::abs(fit.x[p] - parameters[p].neutral) / parameters[p].std);
  return size;
}

Eigen::VectorXd measured(const WindowModel& model) {
  Eigen::VectorXd y(static_cast<Eigen::Index>(model.observation_count()));
  Eigen::Index i = 0;
  for (const DriveWindow& window : model.windows())
    for (const Observation& o : window.observations) y[i++] = o.value;
  return y;
}

FittedExplanation fit_explanation(const Hypothesis& hypothesis, const WindowModel& model,
                                  const NoiseModel& noise, std::span<const double> start,
                                  const ExplanationOptions& options, const std::vector<bool>& fitted_rows) {
  const auto parameters = hypothesis.parameters();
  const auto count = static_cast<Eigen::Index>(parameters.size());
  const Eigen::VectorXd y = measured(model);
  FittedExplanation fit{
      hypothesis, std::vector<double>(start.begin(), start.end()), {}, {}, {}, {}, {}, {}, 0.0, false};
  // Units of the prior: u = (x - neutral) / std.
  const auto units = [&](std::span<const double> x) {
    Eigen::VectorXd u(count);
    for (Eigen::Index p = 0; p < count; ++p) {
      const Parameter& parameter = parameters[static_cast<std::size_t>(p)];
      u[p] = (x[static_cast<std::size_t>(p)] - parameter.neutral) / parameter.std;
    }
    return u;
  };
  const auto weighed = [&](const Eigen::VectorXd& white) {
    Eigen::VectorXd weights = Eigen::VectorXd::Ones(white.size());
    for (Eigen::Index i = 0; i < white.size(); ++i) {
      if (!fitted_rows.empty() && !fitted_rows[static_cast<std::size_t>(i)]) weights[i] = 0.0;
      if (std::abs(white[i]) > options.huber) weights[i] *= options.huber / std::abs(white[i]);
    }
    return weights;
  };
  const auto cost_of = [&](const Eigen::VectorXd& white, const Eigen::VectorXd& u) {
    double cost = 0.5 * u.squaredNorm();
    for (Eigen::Index i = 0; i < white.size(); ++i) {
      if (!fitted_rows.empty() && !fitted_rows[static_cast<std::size_t>(i)]) continue;
      const double a = std::abs(white[i]);
      cost += a <= options.huber ? 0.5 * a * a : options.huber * (a - 0.5 * options.huber);
    }
    return cost;
  };
  std::vector<double> predicted = hypothesis.predict(model, fit.x, options.threads);
  fit.residuals = residuals_of(predicted, noise, y);
  Eigen::VectorXd white = noise.whiten(fit.residuals), u = units(fit.x), weights;
  Eigen::MatrixXd design;
  double cost = cost_of(white, u);
  // Near the answer central differences, once: from there on they hardly change.
  bool near = false, central = false, fresh = false;
  for (int iteration = 0;; ++iteration) {
    const bool last = fit.converged || iteration >= options.iterations || model.cancelled();
    if (!central || !(near || last)) {
      central = near || last;
      fresh = true;
      fit.jacobian = hypothesis.scaled_jacobian(model, fit.x, options.threads,
                                                central ? std::span<const double>{} : predicted);
      design = noise.whiten(fit.jacobian);
    }
    weights = weighed(white);
    const Eigen::MatrixXd weighted = weights.asDiagonal() * design;
    Eigen::MatrixXd hessian = weighted.transpose() * design;
    hessian.diagonal().array() += 1.0;
    const Eigen::LLT<Eigen::MatrixXd> llt(hessian);
    fit.covariance = llt.solve(Eigen::MatrixXd::Identity(count, count));
    if (last) break;
    // r(x + J du) = r - J du; the bounds are held by leaving out what would cross them.
    Eigen::VectorXd gradient = weighted.transpose() * white - u;
    std::vector<Eigen::Index> free;
    Eigen::VectorXd step = Eigen::VectorXd::Zero(count);
    std::vector<bool> held(parameters.size(), false);
    for (int pass = 0; pass < 4; ++pass) {
      free.clear();
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
        const Parameter& parameter = parameters[static_cast<std::size_t>(p)];
        step[p] = solved[static_cast<Eigen::Index>(i)];
        const double low = (parameter.lowest - parameter.neutral) / parameter.std - u[p];
        const double high = (parameter.highest - parameter.neutral) / parameter.std - u[p];
        if (step[p] < low || step[p] > high) {
          step[p] = std::clamp(step[p], low, high);
          held[static_cast<std::size_t>(p)] = true;
          crossed = true;
        }
      }
      if (!crossed) break;
    }
    double largest = 0.0;
    for (Eigen::Index p = 0; p < count; ++p)
      largest = std::max(largest, std::abs(step[p]) / std::sqrt(fit.covariance(p, p)));
    // Half as far until it is better.
    bool better = false;
    for (double share = 1.0; share > 0.05 && !better && !model.cancelled(); share *= 0.5) {
      std::vector<double> x(fit.x.size());
      for (std::size_t p = 0; p < x.size(); ++p)
        x[p] = std::clamp(fit.x[p] + share * step[static_cast<Eigen::Index>(p)] * parameters[p].std,
                          parameters[p].lowest, parameters[p].highest);
      std::vector<double> there = hypothesis.predict(model, x, options.threads);
      Eigen::VectorXd r = residuals_of(there, noise, y);
      const Eigen::VectorXd w = noise.whiten(r);
      const double c = cost_of(w, units(x));
      if (c >= cost) continue;
      better = true;
      fit.converged = cost - c < kLeastFall || share * largest < options.tolerance;
      near = cost - c < kNear;
      fresh = false;
      fit.x = std::move(x);
      predicted = std::move(there);
      fit.residuals = std::move(r);
      white = w;
      u = units(fit.x);
      cost = c;
    }
    if (better) continue;
    // With the better derivatives at hand, no step helps: they are those of the answer.
    fit.converged = near && fresh;
    if (fit.converged) break;
    near = true;
    central = central && fresh;
  }
  fit.row_weights = weights.cwiseSqrt();
  fit.white_jacobian = fit.row_weights.asDiagonal() * design;
  fit.white_linear = fit.row_weights.asDiagonal() * (white + design * u);
  // Laplace: at the most probable parameters, with the curvature there.
  const Eigen::LLT<Eigen::MatrixXd> llt(fit.covariance);
  fit.log_evidence = -cost + llt.matrixLLT().diagonal().array().log().sum();
  // A prior that is cut at the neutral value is twice as dense on its one side.
  for (const Parameter& parameter : parameters)
    if (!parameter.effect.empty() &&
        (parameter.lowest == parameter.neutral || parameter.highest == parameter.neutral))
      fit.log_evidence += std::log(2.0);
  return fit;
}

}  // namespace slipway::gap
