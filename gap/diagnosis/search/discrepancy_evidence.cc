#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

#include "gap/diagnosis/search/discrepancy_term.h"

namespace slipway::gap {
namespace {

Eigen::MatrixXd both(const Eigen::MatrixXd& known, const Eigen::MatrixXd& white, double size) {
  Eigen::MatrixXd columns(known.rows(), known.cols() + white.cols());
  columns << known, size * white;
  return columns;
}

// log_marginal of a fit's residuals beside its columns, those of the form and those of the term, by the sizes
// of the latter two: products of columns are taken once for all sizes.
class SizedMarginal {
 public:
  SizedMarginal(const LinearProblem& fit, const Eigen::MatrixXd& form, const Eigen::MatrixXd& term)
      : known_(fit.columns.cols()), form_(form.cols()), residual_square_(fit.residuals.squaredNorm()) {
    Eigen::MatrixXd all(fit.columns.rows(), known_ + form_ + term.cols());
    all << fit.columns, form, term;
    squares_ = Eigen::MatrixXd::Zero(all.cols(), all.cols());
    squares_.selfadjointView<Eigen::Lower>().rankUpdate(all.transpose());
    products_ = all.transpose() * fit.residuals;
  }

  double operator()(double form_size, double term_size) const {
    Eigen::VectorXd size = Eigen::VectorXd::Constant(squares_.cols(), term_size);
    size.head(known_).setOnes();
    size.segment(known_, form_).setConstant(form_size);
    return log_marginal(residual_square_, size.cwiseProduct(products_),
                        size.asDiagonal() * squares_ * size.asDiagonal());
  }

 private:
  Eigen::Index known_, form_;
  double residual_square_;
  Eigen::MatrixXd squares_;  // the lower half
  Eigen::VectorXd products_;
};

// Every size of form and term; `take` gets whether the term's is that of something else, and says whether to
// go on.
void for_sizes(bool has_form, const DiscrepancyOptions& options,
               const std::function<bool(bool, double, double)>& take) {
  for (const double exact : options.form_sizes) {
    if (exact > 0.0 && !has_form) continue;
    for (const double share : options.imprecision_shares)
      if (!take(false, exact, share * options.imprecision)) return;
    for (const double size : options.sizes)
      if (!take(true, exact, size)) return;
  }
}

// log of the mean of exp(values).
double log_mean_exp(const std::vector<double>& values) {
  const double most = *std::max_element(values.begin(), values.end());
  double sum = 0.0;
  for (const double v : values) sum += std::exp(v - most);
  return most + std::log(sum / static_cast<double>(values.size()));
}

}  // namespace

DiscrepancyGain discrepancy_gain(const PosteriorMode& fit, const Eigen::MatrixXd& term,
                                 const Eigen::MatrixXd& form, const DiscrepancyOptions& options,
                                 const Cancelled& cancelled) {
  if (cancelled()) return {};
  const SizedMarginal marginal(linear_problem(fit), form, term);
  const double without = marginal(0.0, 0.0);
  std::vector<double> imprecise, other;
  for_sizes(form.cols() > 0, options, [&](bool something_else, double exact, double size) {
    if (cancelled()) return false;
    (something_else ? other : imprecise).push_back(marginal(exact, size));
    return true;
  });
  if (cancelled()) return {};
  return {log_mean_exp(imprecise) - without, log_mean_exp(other) - without};
}

DiscrepancyGain discrepancy_gain(const DriveCampaign& campaign, const WindowModel& model,
                                 const NoiseModel& noise, const FittedExplanation& fit,
                                 const DiscrepancyTerm& discrepancy, const DiagnosisOptions& options) {
  return discrepancy_gain(
      fit, whitened(fit, noise, discrepancy),
      form_columns(campaign, model, noise, fit, options.discrepancy, options.search.threads),
      options.discrepancy, [&model] { return model.cancelled(); });
}

Eigen::MatrixXd columns_beside(const PosteriorMode& fit, const Eigen::MatrixXd& term,
                               const Eigen::MatrixXd& form, bool something_else,
                               const DiscrepancyOptions& options, const Cancelled& cancelled) {
  if (cancelled()) return fit.white_jacobian;
  const LinearProblem linear = linear_problem(fit);
  const SizedMarginal marginal(linear, form, term);
  double most = -std::numeric_limits<double>::infinity(), best_exact = 0.0, best_size = 0.0;
  for_sizes(form.cols() > 0, options, [&](bool else_too, double exact, double size) {
    if (cancelled()) return false;
    if (else_too != something_else) return true;
    if (const double value = marginal(exact, size); value > most) {
      most = value;
      best_exact = exact;
      best_size = size;
    }
    return true;
  });
  return both(both(linear.columns, form, best_exact), term, best_size);
}

double most_probable_size(const PosteriorMode& fit, const Eigen::MatrixXd& term,
                          std::span<const double> sizes, const Cancelled& cancelled) {
  if (cancelled()) return sizes.front();
  const SizedMarginal marginal(linear_problem(fit), Eigen::MatrixXd(term.rows(), 0), term);
  double best = -std::numeric_limits<double>::infinity();
  double size = sizes.front();
  for (const double s : sizes) {
    if (cancelled()) break;
    if (const double value = marginal(0.0, s); value > best) {
      best = value;
      size = s;
    }
  }
  return size;
}

DiscrepancyEstimate estimate_discrepancy(const PosteriorMode& fit, const Eigen::MatrixXd& term,
                                         const DiscrepancyOptions& options, const Cancelled& cancelled) {
  const double size = most_probable_size(fit, term, options.sizes, cancelled);
  const LinearProblem linear = linear_problem(fit);
  const Eigen::MatrixXd columns = both(linear.columns, term, size);
  Eigen::MatrixXd hessian = columns.transpose() * columns;
  hessian.diagonal().array() += 1.0;
  const Eigen::LLT<Eigen::MatrixXd> factor(hessian);
  const Eigen::VectorXd all = factor.solve(columns.transpose() * linear.residuals);
  const Eigen::MatrixXd covariance = factor.solve(Eigen::MatrixXd::Identity(columns.cols(), columns.cols()));
  return {size * all.tail(term.cols()), size * covariance.diagonal().tail(term.cols()).cwiseSqrt()};
}

}  // namespace slipway::gap
