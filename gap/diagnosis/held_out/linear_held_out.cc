#include "gap/diagnosis/held_out/linear_held_out.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

namespace slipway::gap {
namespace {

// The ends of what the parameters may be, in prior deviations; columns behind them have none.
struct Bounds {
  Eigen::VectorXd low, high;
};
Bounds bounds_of(std::span<const Parameter> parameters, Eigen::Index columns) {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  Bounds bounds{Eigen::VectorXd::Constant(columns, -kNone), Eigen::VectorXd::Constant(columns, kNone)};
  for (std::size_t p = 0; p < parameters.size(); ++p) {
    const Parameter& parameter = parameters[p];
    bounds.low[static_cast<Eigen::Index>(p)] = (parameter.lowest - parameter.neutral) / parameter.std;
    bounds.high[static_cast<Eigen::Index>(p)] = (parameter.highest - parameter.neutral) / parameter.std;
  }
  return bounds;
}

Eigen::MatrixXd beside(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  if (b.cols() == 0) return a;
  if (a.cols() == 0) return b;
  Eigen::MatrixXd both(a.rows(), a.cols() + b.cols());
  both << a, b;
  return both;
}

// The normal equations of a linear fit, A^T A and A^T w; those of the other folds are all less a fold's own.
struct FoldEquations {
  Eigen::MatrixXd squares;
  Eigen::VectorXd products;
};
FoldEquations equations_of(const Eigen::MatrixXd& columns, const Eigen::VectorXd& white,
                           const std::vector<Eigen::Index>& rows) {
  const Eigen::MatrixXd own = columns(rows, Eigen::all);
  return {own.transpose() * own, own.transpose() * white(rows)};
}

// In deviations of the noise, of those that there are.
double rms_of(const Eigen::VectorXd& residuals, const FoldedRows& rows) {
  double squares = 0.0, count = 0.0;
  for (Eigen::Index row = 0; row < residuals.size(); ++row)
    if (std::isfinite(residuals[row])) {
      squares += 2.0 * rows.loss(residuals[row] / rows.deviation[row]);
      count += 1.0;
    }
  return count > 0.0 ? std::sqrt(squares / count) : 0.0;
}

}  // namespace

Eigen::VectorXd linear_held_out(const PosteriorMode& fit, std::span<const Parameter> parameters,
                                const Eigen::MatrixXd& more, const Eigen::MatrixXd& white_more,
                                const FoldedRows& rows, int folds, const Eigen::MatrixXd& precision) {
  const Eigen::MatrixXd columns = beside(fit.white_jacobian, white_more);
  Eigen::VectorXd found = Eigen::VectorXd::Zero(columns.cols());
  found.head(fit.jacobian.cols()) = in_prior_units(parameters, fit.x);
  Bounds bounds = bounds_of(parameters, columns.cols());
  Eigen::MatrixXd slopes = beside(fit.jacobian, more);
  if (precision.size() > 0) {
    // As the white columns: in directions of deviation 1, which mix what is re-tuned and so have no bounds of
    // their own.
    const Eigen::Index count = fit.jacobian.cols();
    const Eigen::MatrixXd root = prior_root(precision);
    slopes.leftCols(count) = fit.jacobian * root;
    found.head(count) = root.triangularView<Eigen::Upper>().solve(found.head(count));
    for (std::size_t p = 0; p < parameters.size(); ++p)
      if (parameters[p].effect.empty()) {
        bounds.low[static_cast<Eigen::Index>(p)] = -std::numeric_limits<double>::infinity();
        bounds.high[static_cast<Eigen::Index>(p)] = std::numeric_limits<double>::infinity();
      }
  }
  std::vector<std::vector<Eigen::Index>> of_fold(static_cast<std::size_t>(folds));
  for (std::size_t row = 0; row < rows.fold.size(); ++row)
    of_fold[static_cast<std::size_t>(rows.fold[row])].push_back(static_cast<Eigen::Index>(row));
  std::vector<FoldEquations> own;
  FoldEquations all{Eigen::MatrixXd::Identity(columns.cols(), columns.cols()),
                    Eigen::VectorXd::Zero(columns.cols())};
  for (const std::vector<Eigen::Index>& of : of_fold) {
    own.push_back(equations_of(columns, fit.white_linear, of));
    all.squares += own.back().squares;
    all.products += own.back().products;
  }
  Eigen::VectorXd left = Eigen::VectorXd::Constant(fit.residuals.size(), std::nan(""));
  for (std::size_t f = 0; f < of_fold.size(); ++f) {
    std::vector<Eigen::Index> asked;
    for (const Eigen::Index row : of_fold[f])
      if (rows.compared[static_cast<std::size_t>(row)]) asked.push_back(row);
    if (asked.empty() || of_fold[f].size() == rows.fold.size()) continue;
    const Eigen::VectorXd u =
        bounded_step(all.squares - own[f].squares, all.products - own[f].products, bounds.low, bounds.high);
    left(asked) = fit.residuals(asked) + slopes(asked, Eigen::all) * (found - u);
  }
  return left;
}

double linear_held_out_rms(const PosteriorMode& fit, std::span<const Parameter> parameters,
                           const Eigen::MatrixXd& more, const Eigen::MatrixXd& white_more,
                           const FoldedRows& rows, int folds, const Eigen::MatrixXd& precision) {
  return rms_of(linear_held_out(fit, parameters, more, white_more, rows, folds, precision), rows);
}

LinearHeldOut::LinearHeldOut(const PreparedCampaign& prepared, std::span<const std::size_t> groups, int folds,
                             const FitOptions& fit)
    : prepared_(prepared), folds_(folds) {
  rows_.loss = HuberLoss{fit.huber};
  const WindowModel& model = *prepared.model;
  rows_.fold.assign(model.observation_count(), -1);
  rows_.compared.assign(model.observation_count(), false);
  rows_.deviation = prepared.noise->deviation();
  for (std::size_t w = 0; w < prepared.windows.size(); ++w) {
    const DriveWindow& window = prepared.windows[w];
    for (std::size_t i = 0; i < window.observations.size(); ++i) {
      const std::size_t row = model.offset(w) + i;
      const auto r = static_cast<Eigen::Index>(row);
      rows_.fold[row] = static_cast<int>(groups[window.drive] % static_cast<std::size_t>(folds));
      rows_.compared[row] = model.used(w) && rows_.deviation[r] > 0.0 &&
                            std::isfinite(prepared.nominal_residuals[r]) &&
                            !(window.censored && window.observations[i].channel == Channel::kSlip);
    }
  }
}

Eigen::VectorXd LinearHeldOut::residuals(const FittedExplanation& fit, const Eigen::MatrixXd& more) const {
  const Eigen::MatrixXd white_more =
      more.cols() == 0 ? Eigen::MatrixXd{}
                       : Eigen::MatrixXd(fit.row_weights.asDiagonal() * prepared_.noise->whiten(more));
  // What a reference left open stands beside the fit's white columns already.
  const LearntDifference* const learnt = prepared_.model->learnt();
  return linear_held_out(fit, fit.hypothesis.parameters(), learnt ? beside(learnt->left, more) : more,
                         white_more, rows_, folds_, fit.hypothesis.prior_precision());
}

double LinearHeldOut::operator()(const FittedExplanation& fit, const Eigen::MatrixXd& more) const {
  return rms_of(residuals(fit, more), rows_);
}

}  // namespace slipway::gap
