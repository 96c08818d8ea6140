#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "gap/diagnosis/result/result.h"
#include "gap/diagnosis/search/explanation_search.h"
#include "gap/diagnosis/search/prepared_campaign.h"

namespace slipway::gap {

// Rows of observations by the fold of their drive, whether they are compared, and the deviation of their
// noise.
struct FoldedRows {
  std::vector<int> fold;
  std::vector<bool> compared;
  Eigen::VectorXd deviation;
};

// Root mean square of prediction less measurement, in deviations of the noise, on drives that an explanation
// has not seen, its derivatives being taken for constant: each fold's parameters are solved for from the
// other folds' rows (whitened, with a prior of deviation 1 and held within their bounds), and predictions
// move along the derivatives. `more` has columns behind the fit's own (observations x columns, by prior
// deviations), and `white_more` the same whitened, rows weighed as in the fit; both may be empty.
// `precision`: of the prior where reference drives told of it, see Hypothesis::prior_precision(); `more` then
// begins with what they left open, which is behind the fit's white columns already.
double linear_held_out_rms(const PosteriorMode& fit, std::span<const Parameter> parameters,
                           const Eigen::MatrixXd& more, const Eigen::MatrixXd& white_more,
                           const FoldedRows& rows, int folds, const Eigen::MatrixXd& precision = {});

// The same of a campaign's explanations. It costs no prediction, so that every explanation can be asked.
class LinearHeldOut {
 public:
  // `groups`: of each drive, see learnt_from_in. What is given must outlive it.
  LinearHeldOut(const PreparedCampaign& prepared, std::span<const std::size_t> groups, int folds);

  double operator()(const FittedExplanation& fit, const Eigen::MatrixXd& more = {}) const;

 private:
  const PreparedCampaign& prepared_;
  FoldedRows rows_;
  int folds_;
};

// The shares of the held-out gap that go with single causes. The gap is what re-tuning leaves above the
// floor, r(nothing) - 1, or what the best explanation closes, if that is more. A cause alone closes
// r(nothing) - r(cause). In a pair it has the mean of what it closes first and what it closes after the
// other, so that the shares of both add up to what the pair closes [Shapley 1953].
class ClosedShares {
 public:
  // Of a fit, and of columns beside it: as LinearHeldOut. The floor of both is 1. `search` must outlive it.
  using Rms = std::function<double(const FittedExplanation&, const Eigen::MatrixXd&)>;
  ClosedShares(Rms rms, const ExplanationSearch& search);
  // Of a cause in the most probable explanation that has it; of one that was not fitted by its derivatives
  // beside the re-tuned parameters. Within 0 and 1.
  double of(const std::string& cause) const;

 private:
  using Names = std::set<std::string>;
  double rms_of(const Names& names) const;  // where it was not fitted, that of nothing

  Rms rms_;
  const ExplanationSearch& search_;
  std::map<Names, double> rms_with_;
  double nothing_ = 0.0, gap_ = 0.0;
};

// The sum of the probabilities of all sets that have the effect.
double marginal_probability(std::span<const ComparedSet> sets, const std::string& effect);

// Of every effect in the library, the most probable first.
std::vector<EffectMarginal> effect_marginals(std::span<const std::string> library,
                                             const ExplanationSearch& search, const ClosedShares& shares);

}  // namespace slipway::gap
