#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "gap/diagnosis/search/discrepancy_term.h"

namespace slipway::gap {
namespace {

Eigen::MatrixXd both(const Eigen::MatrixXd& known, const Eigen::MatrixXd& more) {
  Eigen::MatrixXd columns(known.rows(), known.cols() + more.cols());
  columns << known, more;
  return columns;
}

// Deviations of the coefficients of a form and a term: one each, and of one of the term's columns so much
// more.
struct Sizes {
  double form = 0.0, term = 0.0;
  Eigen::Index single = -1;  // none
  double single_size = 0.0;

  Eigen::VectorXd of_term(Eigen::Index columns) const {
    Eigen::VectorXd sizes = Eigen::VectorXd::Constant(columns, term);
    if (single >= 0) sizes[single] = std::hypot(term, single_size);
    return sizes;
  }
};

// log_marginal of a fit's residuals beside its columns, those of the form and those of the term, by the sizes
// of the latter two: products of columns are taken once for all sizes.
class SizedMarginal {
 public:
  SizedMarginal(const LinearProblem& fit, const Eigen::MatrixXd& form, const WhiteTerm& term)
      : known_(fit.columns.cols()),
        form_(form.cols()),
        term_(term.columns.cols()),
        single_(term.single),
        residual_square_(fit.residuals.squaredNorm()) {
    const Eigen::MatrixXd all = both(both(fit.columns, form), term.columns);
    squares_ = Eigen::MatrixXd::Zero(all.cols(), all.cols());
    squares_.selfadjointView<Eigen::Lower>().rankUpdate(all.transpose());
    squares_.triangularView<Eigen::StrictlyUpper>() = squares_.transpose();
    products_ = all.transpose() * fit.residuals;
  }

  double operator()(double form_size, double term_size) const {
    const Eigen::VectorXd size = sizes(form_size, term_size);
    return log_marginal(residual_square_, size.cwiseProduct(products_),
                        size.asDiagonal() * squares_ * size.asDiagonal());
  }

  // The term's columns that may stand alone.
  std::span<const Eigen::Index> single() const { return single_; }
  // By how much the above rises where one of these has so much more: single columns x more. A column adds
  // a rank to the covariance, which has a closed form.
  Eigen::MatrixXd with_single(double form_size, double term_size, std::span<const double> more) const {
    const Eigen::VectorXd size = sizes(form_size, term_size);
    Eigen::MatrixXd inner = size.asDiagonal() * squares_ * size.asDiagonal();
    inner.diagonal().array() += 1.0;
    const Eigen::LLT<Eigen::MatrixXd> llt(inner);
    const Eigen::MatrixXd single = squares_.rightCols(term_)(Eigen::all, single_);
    const Eigen::MatrixXd taken = llt.matrixL().solve(size.asDiagonal() * single);
    const Eigen::VectorXd taken_products = llt.matrixL().solve(size.cwiseProduct(products_));
    const Eigen::ArrayXd square =
        squares_.diagonal().tail(term_)(single_) - taken.colwise().squaredNorm().transpose();
    const Eigen::ArrayXd product = products_.tail(term_)(single_) - taken.transpose() * taken_products;
    Eigen::MatrixXd gains(single.cols(), static_cast<Eigen::Index>(more.size()));
    for (std::size_t m = 0; m < more.size(); ++m) {
      const Eigen::ArrayXd variance = more[m] * more[m] * square;
      gains.col(static_cast<Eigen::Index>(m)) =
          0.5 * more[m] * more[m] * product.square() / (1.0 + variance) - 0.5 * variance.log1p();
    }
    return gains;
  }

 private:
  Eigen::VectorXd sizes(double form_size, double term_size) const {
    Eigen::VectorXd size = Eigen::VectorXd::Constant(squares_.cols(), term_size);
    size.head(known_).setOnes();
    size.segment(known_, form_).setConstant(form_size);
    return size;
  }

  Eigen::Index known_, form_, term_;
  std::vector<Eigen::Index> single_;
  double residual_square_;
  Eigen::MatrixXd squares_;
  Eigen::VectorXd products_;
};

// Three ways in which a term may stand beside an explanation.
enum class Way {
  kImprecision,
  kSingle,  // something else that enters at one point by one circumstance, beside the imprecision
  kSmooth   // something else at all points by all circumstances at once
};

// The log marginals of every way and size, or those of imprecision alone; `take` says whether to go on.
void for_sizes(const SizedMarginal& marginal, bool has_form, bool something_else,
               const DiscrepancyOptions& options,
               const std::function<bool(Way, const Sizes&, double)>& take) {
  for (const double exact : options.form_sizes) {
    if (exact > 0.0 && !has_form) continue;
    for (const double share : options.imprecision_shares) {
      Sizes sizes{exact, share * options.imprecision};
      const double imprecise = marginal(sizes.form, sizes.term);
      if (!take(Way::kImprecision, sizes, imprecise)) return;
      if (!something_else) continue;
      const std::span<const Eigen::Index> single = marginal.single();
      const Eigen::MatrixXd gains = marginal.with_single(sizes.form, sizes.term, options.sizes);
      for (Eigen::Index m = 0; m < gains.cols(); ++m)
        for (std::size_t c = 0; c < single.size(); ++c) {
          sizes.single = single[c];
          sizes.single_size = options.sizes[static_cast<std::size_t>(m)];
          if (!take(Way::kSingle, sizes, imprecise + gains(static_cast<Eigen::Index>(c), m))) return;
        }
    }
    if (!something_else) continue;
    for (const double size : options.sizes)
      if (!take(Way::kSmooth, {exact, size}, marginal(exact, size))) return;
  }
}

// log of the mean of exp(values).
double log_mean_exp(const std::vector<double>& values) {
  if (values.empty()) return -std::numeric_limits<double>::infinity();
  const double most = *std::max_element(values.begin(), values.end());
  double sum = 0.0;
  for (const double v : values) sum += std::exp(v - most);
  return most + std::log(sum / static_cast<double>(values.size()));
}

// Of something else, or of imprecision, the sizes with the most evidence.
Sizes most_probable(const SizedMarginal& marginal, bool has_form, bool something_else,
                    const DiscrepancyOptions& options, const Cancelled& cancelled) {
  Sizes best;
  double most = -std::numeric_limits<double>::infinity();
  for_sizes(marginal, has_form, something_else, options, [&](Way way, const Sizes& sizes, double value) {
    if ((way != Way::kImprecision) != something_else || value <= most) return !cancelled();
    most = value;
    best = sizes;
    return !cancelled();
  });
  return best;
}

}  // namespace

DiscrepancyGain discrepancy_gain(const PosteriorMode& fit, const WhiteTerm& term, const Eigen::MatrixXd& form,
                                 const DiscrepancyOptions& options, const Cancelled& cancelled) {
  if (cancelled()) return {};
  const SizedMarginal marginal(linear_problem(fit), form, term);
  const double without = marginal(0.0, 0.0);
  std::array<std::vector<double>, 3> values;
  for_sizes(marginal, form.cols() > 0, true, options, [&](Way way, const Sizes&, double value) {
    values[static_cast<std::size_t>(way)].push_back(value);
    return !cancelled();
  });
  if (cancelled()) return {};
  const auto mean = [&](Way way) { return log_mean_exp(values[static_cast<std::size_t>(way)]) - without; };
  const double single = mean(Way::kSingle) + std::log(options.single_share);
  const double smooth = mean(Way::kSmooth) + std::log1p(-options.single_share);
  const double most = std::max(single, smooth);
  return {mean(Way::kImprecision), most + std::log(std::exp(single - most) + std::exp(smooth - most))};
}

DiscrepancyGain discrepancy_gain(const DriveCampaign& campaign, const WindowModel& model,
                                 const NoiseModel& noise, const FittedExplanation& fit,
                                 const DiscrepancyTerm& discrepancy, const DiagnosisOptions& options) {
  return discrepancy_gain(
      fit, whitened(fit, noise, discrepancy),
      form_columns(campaign, model, noise, fit, options.discrepancy, options.search.threads),
      options.discrepancy, [&model] { return model.cancelled(); });
}

Eigen::MatrixXd columns_beside(const PosteriorMode& fit, const WhiteTerm& term, const Eigen::MatrixXd& form,
                               bool something_else, const DiscrepancyOptions& options,
                               const Cancelled& cancelled) {
  if (cancelled()) return fit.white_jacobian;
  const LinearProblem linear = linear_problem(fit);
  const Sizes best =
      most_probable(SizedMarginal(linear, form, term), form.cols() > 0, something_else, options, cancelled);
  return both(both(linear.columns, best.form * form),
              term.columns * best.of_term(term.columns.cols()).asDiagonal());
}

double most_probable_size(const PosteriorMode& fit, const WhiteTerm& term, std::span<const double> sizes,
                          const Cancelled& cancelled) {
  if (cancelled()) return sizes.front();
  const SizedMarginal marginal(linear_problem(fit), Eigen::MatrixXd(term.columns.rows(), 0), term);
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

DiscrepancyEstimate estimate_discrepancy(const PosteriorMode& fit, const WhiteTerm& term,
                                         const DiscrepancyOptions& options, const Cancelled& cancelled) {
  const LinearProblem linear = linear_problem(fit);
  const Eigen::VectorXd size =
      most_probable(SizedMarginal(linear, Eigen::MatrixXd(term.columns.rows(), 0), term), false, true,
                    options, cancelled)
          .of_term(term.columns.cols());
  const Eigen::MatrixXd columns = both(linear.columns, term.columns * size.asDiagonal());
  Eigen::MatrixXd hessian = columns.transpose() * columns;
  hessian.diagonal().array() += 1.0;
  const Eigen::LLT<Eigen::MatrixXd> factor(hessian);
  const Eigen::VectorXd all = factor.solve(columns.transpose() * linear.residuals);
  const Eigen::MatrixXd covariance = factor.solve(Eigen::MatrixXd::Identity(columns.cols(), columns.cols()));
  return {size.cwiseProduct(all.tail(term.columns.cols())),
          size.cwiseProduct(covariance.diagonal().tail(term.columns.cols()).cwiseSqrt())};
}

}  // namespace slipway::gap
