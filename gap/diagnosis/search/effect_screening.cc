#include "gap/diagnosis/search/effect_screening.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "core/parallel_for.h"
#include "gap/diagnosis/search/linear_gain.h"

namespace slipway::gap {
namespace {

// Of an effect that is in the fit already: below every gain.
constexpr double kInTheFit = -1e9;

// Of a fit's parameters those that drives have to tell.
std::vector<Eigen::Index> retuned_columns(const FittedExplanation& fit) {
  std::vector<Eigen::Index> columns;
  const auto parameters = fit.hypothesis.parameters();
  for (std::size_t p = 0; p < parameters.size(); ++p)
    if (parameters[p].is_told_by_drives()) columns.push_back(static_cast<Eigen::Index>(p));
  return columns;
}

// What screening knows of a fit: the directions that re-tuning takes, and what the fit predicts.
struct Known {
  Eigen::MatrixXd basis;
  std::vector<double> predicted;
  // With a reference, which told how far each direction can be re-tuned: the fit's columns, and the factor of
  // their squares with the prior.
  Eigen::MatrixXd believed;
  Eigen::LLT<Eigen::MatrixXd> factor;

  // What is left of responses when what re-tuning takes is taken out.
  Eigen::MatrixXd beside_retuning(const Eigen::MatrixXd& responses) const {
    return responses - basis * (basis.transpose() * responses);
  }

  // Length of what is left of a response when what re-tuning takes is taken out; in every direction wholly
  // where nobody told how far it may go.
  double visibility(const Eigen::VectorXd& response) const {
    if (believed.size() == 0) return beside_retuning(response).norm();
    const Eigen::VectorXd crossed = believed.transpose() * response;
    return std::sqrt(std::max(0.0, response.squaredNorm() - crossed.dot(factor.solve(crossed))));
  }
};

// Of the columns by which a direction is explained best, those with the largest parts: every one with half of
// the largest at least, three at most.
std::vector<std::size_t> largest_parts(const Eigen::MatrixXd& columns, const Eigen::VectorXd& direction) {
  Eigen::MatrixXd hessian = columns.transpose() * columns;
  hessian.diagonal().array() += 1.0;  // parameters that nothing shows take nothing
  const Eigen::VectorXd parts = (hessian.llt().solve(columns.transpose() * direction).array().abs() *
                                 columns.colwise().norm().transpose().array())
                                    .matrix();
  std::vector<std::size_t> order(static_cast<std::size_t>(parts.size()));
  for (std::size_t p = 0; p < order.size(); ++p) order[p] = p;
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return parts[static_cast<Eigen::Index>(a)] > parts[static_cast<Eigen::Index>(b)];
  });
  constexpr std::size_t kMaxParts = 3;
  if (order.size() > kMaxParts) order.resize(kMaxParts);
  const double least = order.empty() ? 0.0 : 0.5 * parts[static_cast<Eigen::Index>(order.front())];
  std::erase_if(order, [&](std::size_t p) { return parts[static_cast<Eigen::Index>(p)] < least; });
  return order;
}

// Fields that show by less than one deviation look like nothing.
Eigen::MatrixXd reach_of(const Eigen::MatrixXd& columns) {
  std::vector<Eigen::Index> shown;
  for (Eigen::Index c = 0; c < columns.cols(); ++c)
    if (columns.col(c).norm() >= 1.0) shown.push_back(c);
  return spanned_by(columns(Eigen::all, shown));
}

// A variant that is not in the fit.
ScreenedEffect screened(std::size_t variant, const Hypothesis& with, const WindowModel& model,
                        const NoiseModel& noise, const FittedExplanation& fit, const Known& known,
                        const KnownColumns& fitted) {
  ScreenedEffect effect;
  effect.variant = variant;
  effect.columns = added_derivatives(with, model, fit, effect.start, known.predicted);
  const Eigen::MatrixXd columns = fit.row_weights.asDiagonal() * noise.whiten(effect.columns);
  const auto added = with.parameters().subspan(fit.x.size());
  const LinearGain found = linear_gain(fitted, columns, added);
  effect.gain = found.gain;
  for (std::size_t p = 0; p < added.size(); ++p)
    effect.start[fit.x.size() + p] =
        std::clamp(added[p].neutral + added[p].std * found.estimate[static_cast<Eigen::Index>(p)],
                   added[p].lowest, added[p].highest);
  // What the found combination does; of one that is not there, the first field.
  Eigen::VectorXd direction = columns * found.estimate;
  if (found.estimate.squaredNorm() == 0.0) direction = columns.col(0);
  effect.signature = known.beside_retuning(direction);
  effect.reach = reach_of(known.beside_retuning(columns));
  const double length = direction.norm();
  effect.taken_by =
      largest_parts(fit.white_jacobian.leftCols(static_cast<Eigen::Index>(fit.x.size())), direction);
  effect.kept_share = length > 0.0 ? effect.signature.norm() / length : 0.0;
  effect.visibility = known.visibility(columns.col(0));
  return effect;
}

}  // namespace

std::vector<ScreenedEffect> screen_effects(const DriveCampaign& campaign, const WindowModel& model,
                                           const NoiseModel& noise, const FittedExplanation& fit,
                                           const DiscrepancyTerm& discrepancy,
                                           std::span<const EffectVariant> variants,
                                           const DiscrepancyOptions& options, std::size_t threads) {
  Known known;
  const LinearProblem linear = linear_problem(fit);
  known.basis = spanned_by(fit.white_jacobian(Eigen::all, retuned_columns(fit)));
  if (fit.hypothesis.prior_precision().size() > 0) {
    known.believed = fit.white_jacobian;
    Eigen::MatrixXd squares = known.believed.transpose() * known.believed;
    squares.diagonal().array() += 1.0;
    known.factor.compute(squares);
  }
  known.predicted = fit.hypothesis.predict(model, fit.x, threads);
  // The fit's columns with those of the discrepancy term.
  Eigen::MatrixXd columns(linear.columns.rows(), linear.columns.cols() + discrepancy.values.cols());
  columns << linear.columns, options.imprecision * whitened(fit, noise, discrepancy).columns;
  const KnownColumns fitted(linear.residuals, columns);
  std::vector<ScreenedEffect> all(variants.size());
  parallel_for(variants.size(), threads, [&](std::size_t v) {
    if (model.cancelled()) return;
    std::vector<EffectVariant> effects(fit.hypothesis.effects().begin(), fit.hypothesis.effects().end());
    if (std::any_of(effects.begin(), effects.end(),
                    [&](const EffectVariant& there) { return there.effect == variants[v].effect; })) {
      all[v] = {v, kInTheFit, {}, {}, 0.0, 0.0, {}, {}, {}};
      return;
    }
    effects.push_back(variants[v]);
    all[v] = screened(v, Hypothesis(campaign, effects), model, noise, fit, known, fitted);
  });
  std::stable_sort(all.begin(), all.end(),
                   [](const ScreenedEffect& a, const ScreenedEffect& b) { return a.gain > b.gain; });
  return all;
}

}  // namespace slipway::gap
