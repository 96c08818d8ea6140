#include "gap/diagnosis/search/effect_screening.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "core/parallel_for.h"

namespace slipway::gap {
namespace {

// Linear evidence of columns beside a fit, one-sided ones kept on their side, and the estimate.
double linear_gain(const FittedExplanation& fit, const Eigen::MatrixXd& known, const Eigen::MatrixXd& columns,
                   std::span<const Parameter> parameters, Eigen::VectorXd& estimate) {
  std::vector<Eigen::Index> kept;
  for (Eigen::Index c = 0; c < columns.cols(); ++c) kept.push_back(c);
  estimate = Eigen::VectorXd::Zero(columns.cols());
  const double without = log_marginal(fit.white_linear, known);
  for (;;) {
    if (kept.empty()) return 0.0;
    Eigen::MatrixXd all(columns.rows(), known.cols() + static_cast<Eigen::Index>(kept.size()));
    all << known, columns(Eigen::all, kept);
    Eigen::MatrixXd hessian = all.transpose() * all;
    hessian.diagonal().array() += 1.0;
    const Eigen::VectorXd solved = hessian.llt().solve(all.transpose() * fit.white_linear).tail(kept.size());
    std::vector<Eigen::Index> allowed;
    for (std::size_t i = 0; i < kept.size(); ++i) {
      const Parameter& p = parameters[static_cast<std::size_t>(kept[i])];
      const double value = p.neutral + p.std * solved[static_cast<Eigen::Index>(i)];
      if ((p.lowest == p.neutral && value < p.neutral) || (p.highest == p.neutral && value > p.neutral))
        continue;
      allowed.push_back(kept[i]);
    }
    if (allowed.size() == kept.size()) {
      double gain = log_marginal(fit.white_linear, all) - without;
      for (std::size_t i = 0; i < kept.size(); ++i) {
        const Parameter& p = parameters[static_cast<std::size_t>(kept[i])];
        estimate[kept[i]] = std::clamp(solved[static_cast<Eigen::Index>(i)], (p.lowest - p.neutral) / p.std,
                                       (p.highest - p.neutral) / p.std);
        if (p.lowest == p.neutral || p.highest == p.neutral) gain += std::log(2.0);
      }
      return gain;
    }
    kept = std::move(allowed);
  }
}

}  // namespace

std::vector<ScreenedEffect> screen_effects(const DriveCampaign& campaign, const WindowModel& model,
                                           const NoiseModel& noise, const FittedExplanation& fit,
                                           const DiscrepancyTerm& discrepancy,
                                           std::span<const EffectVariant> variants, std::size_t threads) {
  std::vector<ScreenedEffect> all(variants.size());
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(fit.white_jacobian);
  const Eigen::MatrixXd basis =
      qr.householderQ() * Eigen::MatrixXd::Identity(fit.white_jacobian.rows(), fit.white_jacobian.cols());
  Eigen::MatrixXd known(fit.white_jacobian.rows(), fit.white_jacobian.cols() + discrepancy.values.cols());
  known << fit.white_jacobian, kImprecision * whitened(fit, noise, discrepancy);
  parallel_for(variants.size(), threads, [&](std::size_t v) {
    if (model.cancelled()) return;
    std::vector<EffectVariant> effects(fit.hypothesis.effects().begin(), fit.hypothesis.effects().end());
    for (const EffectVariant& there : effects)
      if (there.effect == variants[v].effect) {
        all[v] = {v, -1e9, {}, {}, 0.0, 0.0};
        return;
      }
    effects.push_back(variants[v]);
    const Hypothesis hypothesis(campaign, effects);
    std::vector<double> start;
    const Eigen::MatrixXd columns = added_columns(hypothesis, model, noise, fit, start);
    Eigen::VectorXd estimate;
    const auto added = hypothesis.parameters().subspan(fit.x.size());
    const double gain = linear_gain(fit, known, columns, added, estimate);
    for (std::size_t p = 0; p < added.size(); ++p)
      start[fit.x.size() + p] =
          std::clamp(added[p].neutral + added[p].std * estimate[static_cast<Eigen::Index>(p)],
                     added[p].lowest, added[p].highest);
    // What the found combination does; of one that is not there, the first field.
    Eigen::VectorXd direction = columns * estimate;
    if (estimate.squaredNorm() == 0.0) direction = columns.col(0);
    const Eigen::VectorXd projected = direction - basis * (basis.transpose() * direction);
    const double length = direction.norm();
    const Eigen::VectorXd first = columns.col(0) - basis * (basis.transpose() * columns.col(0));
    all[v] = {v,           gain, std::move(start), projected, length > 0.0 ? projected.norm() / length : 0.0,
              first.norm()};
  });
  std::stable_sort(all.begin(), all.end(),
                   [](const ScreenedEffect& a, const ScreenedEffect& b) { return a.gain > b.gain; });
  return all;
}

}  // namespace slipway::gap
