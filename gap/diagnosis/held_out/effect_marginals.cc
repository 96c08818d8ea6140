#include "gap/diagnosis/held_out/effect_marginals.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace slipway::gap {
namespace {

// Held within what the parameters may be, in prior deviations.
void hold_within_bounds(std::span<const Parameter> parameters, Eigen::VectorXd& u) {
  for (std::size_t p = 0; p < parameters.size(); ++p) {
    const Parameter& parameter = parameters[p];
    double& value = u[static_cast<Eigen::Index>(p)];
    value = std::clamp(value, (parameter.lowest - parameter.neutral) / parameter.std,
                       (parameter.highest - parameter.neutral) / parameter.std);
  }
}

Eigen::MatrixXd beside(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  if (b.cols() == 0) return a;
  Eigen::MatrixXd both(a.rows(), a.cols() + b.cols());
  both << a, b;
  return both;
}

}  // namespace

LinearHeldOut::LinearHeldOut(const PreparedCampaign& prepared, std::span<const std::size_t> groups, int folds)
    : prepared_(prepared),
      fold_of_row_(prepared.model->observation_count(), -1),
      compared_(prepared.model->observation_count(), false),
      folds_(folds) {
  for (std::size_t w = 0; w < prepared.windows.size(); ++w) {
    const DriveWindow& window = prepared.windows[w];
    for (std::size_t i = 0; i < window.observations.size(); ++i) {
      const std::size_t row = prepared.model->offset(w) + i;
      const auto r = static_cast<Eigen::Index>(row);
      fold_of_row_[row] = static_cast<int>(groups[window.drive] % static_cast<std::size_t>(folds));
      compared_[row] = prepared.model->used(w) && prepared.noise->deviation()[r] > 0.0 &&
                       std::isfinite(prepared.nominal_residuals[r]) &&
                       !(window.censored && window.observations[i].channel == Channel::kSlip);
    }
  }
}

double LinearHeldOut::rms(const FittedExplanation& fit, const Eigen::MatrixXd& more) const {
  const Eigen::MatrixXd slopes = beside(fit.jacobian, more);
  const Eigen::MatrixXd columns =
      more.cols() == 0
          ? fit.white_jacobian
          : beside(fit.white_jacobian, fit.row_weights.asDiagonal() * prepared_.noise->whiten(more));
  Eigen::VectorXd found = Eigen::VectorXd::Zero(columns.cols());
  found.head(fit.jacobian.cols()) = in_prior_units(fit.hypothesis.parameters(), fit.x);
  double squares = 0.0, count = 0.0;
  for (int f = 0; f < folds_; ++f) {
    std::vector<Eigen::Index> learnt, asked;
    for (std::size_t row = 0; row < fold_of_row_.size(); ++row) {
      if (fold_of_row_[row] != f) learnt.push_back(static_cast<Eigen::Index>(row));
      if (fold_of_row_[row] == f && compared_[row]) asked.push_back(static_cast<Eigen::Index>(row));
    }
    if (asked.empty() || learnt.empty()) continue;
    const Eigen::MatrixXd of_learnt = columns(learnt, Eigen::all);
    Eigen::MatrixXd hessian = of_learnt.transpose() * of_learnt;
    hessian.diagonal().array() += 1.0;
    Eigen::VectorXd u = hessian.llt().solve(of_learnt.transpose() * fit.white_linear(learnt));
    hold_within_bounds(fit.hypothesis.parameters(), u);
    const Eigen::VectorXd moved = slopes(asked, Eigen::all) * (found - u);
    for (std::size_t i = 0; i < asked.size(); ++i) {
      const double r = (fit.residuals[asked[i]] + moved[static_cast<Eigen::Index>(i)]) /
                       prepared_.noise->deviation()[asked[i]];
      squares += r * r;
      count += 1.0;
    }
  }
  return count > 0.0 ? std::sqrt(squares / count) : 0.0;
}

ClosedShares::ClosedShares(const LinearHeldOut& held_out, const ExplanationSearch& search)
    : held_out_(held_out), search_(search), nothing_(held_out.rms(search.fits[0])) {
  double least = nothing_;
  for (const Candidate& c : search.candidates) {
    const auto [place, is_new] = rms_.try_emplace(Names(c.effects.begin(), c.effects.end()), 0.0);
    if (is_new) place->second = held_out.rms(search.fits[c.fit]);
    least = std::min(least, place->second);
  }
  gap_ = nothing_ - std::min(1.0, least);
}

double ClosedShares::rms_of(const Names& names) const {
  const auto known = rms_.find(names);
  return known == rms_.end() ? nothing_ : known->second;
}

double ClosedShares::of(const std::string& cause) const {
  if (!(gap_ > 0.0)) return 0.0;
  const auto in = std::find_if(search_.candidates.begin(), search_.candidates.end(), [&](const Candidate& c) {
    return std::find(c.effects.begin(), c.effects.end(), cause) != c.effects.end();
  });
  double closed = 0.0;
  if (in != search_.candidates.end()) {
    const Names all(in->effects.begin(), in->effects.end());
    Names others = all;
    others.erase(cause);
    closed = rms_of(others) - rms_of(all);
    if (!others.empty()) closed = 0.5 * (closed + nothing_ - rms_of({cause}));
  } else {
    const auto screened = std::find_if(search_.screened.begin(), search_.screened.end(),
                                       [&](const ScreenedVariant& s) { return s.variant.effect == cause; });
    if (screened == search_.screened.end() || screened->columns.cols() == 0) return 0.0;
    closed = nothing_ - held_out_.rms(search_.fits[0], screened->columns);
  }
  return std::clamp(closed / gap_, 0.0, 1.0);
}

double marginal_probability(std::span<const ComparedSet> sets, const std::string& effect) {
  double sum = 0.0;
  for (const ComparedSet& set : sets)
    if (std::find(set.effects.begin(), set.effects.end(), effect) != set.effects.end())
      sum += set.probability;
  return sum;
}

std::vector<EffectMarginal> effect_marginals(std::span<const std::string> library,
                                             const ExplanationSearch& search, const ClosedShares& shares) {
  std::vector<EffectMarginal> marginals;
  for (const std::string& effect : library) {
    double probability = 0.0;
    for (const Candidate& c : search.candidates)
      if (std::find(c.effects.begin(), c.effects.end(), effect) != c.effects.end())
        probability += c.probability;
    marginals.push_back({effect, probability, shares.of(effect)});
  }
  std::stable_sort(marginals.begin(), marginals.end(), [](const EffectMarginal& a, const EffectMarginal& b) {
    return a.probability != b.probability ? a.probability > b.probability : a.closed_share > b.closed_share;
  });
  return marginals;
}

}  // namespace slipway::gap
