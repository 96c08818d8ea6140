#include "gap/diagnosis/held_out/effect_marginals.h"

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

}  // namespace

double linear_held_out_rms(const PosteriorMode& fit, std::span<const Parameter> parameters,
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
  double squares = 0.0, count = 0.0;
  for (int f = 0; f < folds; ++f) {
    std::vector<Eigen::Index> learnt, asked;
    for (std::size_t row = 0; row < rows.fold.size(); ++row) {
      if (rows.fold[row] != f) learnt.push_back(static_cast<Eigen::Index>(row));
      if (rows.fold[row] == f && rows.compared[row]) asked.push_back(static_cast<Eigen::Index>(row));
    }
    if (asked.empty() || learnt.empty()) continue;
    const Eigen::MatrixXd of_learnt = columns(learnt, Eigen::all);
    Eigen::MatrixXd hessian = of_learnt.transpose() * of_learnt;
    hessian.diagonal().array() += 1.0;
    const Eigen::VectorXd u =
        bounded_step(hessian, of_learnt.transpose() * fit.white_linear(learnt), bounds.low, bounds.high);
    const Eigen::VectorXd moved = slopes(asked, Eigen::all) * (found - u);
    for (std::size_t i = 0; i < asked.size(); ++i) {
      const double r =
          (fit.residuals[asked[i]] + moved[static_cast<Eigen::Index>(i)]) / rows.deviation[asked[i]];
      squares += r * r;
      count += 1.0;
    }
  }
  return count > 0.0 ? std::sqrt(squares / count) : 0.0;
}

LinearHeldOut::LinearHeldOut(const PreparedCampaign& prepared, std::span<const std::size_t> groups, int folds)
    : prepared_(prepared), folds_(folds) {
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

double LinearHeldOut::operator()(const FittedExplanation& fit, const Eigen::MatrixXd& more) const {
  const Eigen::MatrixXd white_more =
      more.cols() == 0 ? Eigen::MatrixXd{}
                       : Eigen::MatrixXd(fit.row_weights.asDiagonal() * prepared_.noise->whiten(more));
  // What a reference left open stands beside the fit's white columns already.
  const LearntDifference* const learnt = prepared_.model->learnt();
  return linear_held_out_rms(fit, fit.hypothesis.parameters(), learnt ? beside(learnt->left, more) : more,
                             white_more, rows_, folds_, fit.hypothesis.prior_precision());
}

ClosedShares::ClosedShares(Rms rms, const ExplanationSearch& search)
    : rms_(std::move(rms)), search_(search), nothing_(rms_(search.fits[0], {})) {
  double least = nothing_;
  for (const Candidate& c : search.candidates) {
    const auto [place, is_new] = rms_with_.try_emplace(Names(c.effects.begin(), c.effects.end()), 0.0);
    if (is_new) place->second = rms_(search.fits[c.fit], {});
    least = std::min(least, place->second);
  }
  gap_ = nothing_ - std::min(1.0, least);
}

double ClosedShares::rms_of(const Names& names) const {
  const auto known = rms_with_.find(names);
  return known == rms_with_.end() ? nothing_ : known->second;
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
    closed = std::max(0.0, rms_of(others) - rms_of(all));
    if (!others.empty()) closed = 0.5 * (closed + std::max(0.0, nothing_ - rms_of({cause})));
  } else {
    const auto screened = std::find_if(search_.screened.begin(), search_.screened.end(),
                                       [&](const ScreenedVariant& s) { return s.variant.effect == cause; });
    if (screened == search_.screened.end() || screened->columns.cols() == 0) return 0.0;
    closed = nothing_ - rms_(search_.fits[0], screened->columns);
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
