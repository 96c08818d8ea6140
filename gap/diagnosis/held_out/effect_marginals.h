#pragma once

#include <cstddef>
#include <map>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "gap/diagnosis/result/result.h"
#include "gap/diagnosis/search/explanation_search.h"
#include "gap/diagnosis/search/prepared_campaign.h"

namespace slipway::gap {

// How far an explanation is off on drives that it has not seen, with its derivatives taken for constant: each
// fold's parameters are solved for from the other folds' drives, and predictions move along the derivatives.
// It costs no prediction, so that every explanation can be asked.
class LinearHeldOut {
 public:
  // `groups`: of each drive, see learnt_from_in. What is given must outlive it.
  LinearHeldOut(const PreparedCampaign& prepared, std::span<const std::size_t> groups, int folds);

  // Root mean square of prediction less measurement over all folds' drives, in deviations of the noise (its
  // floor is 1). `more` has further columns (observations x columns, by prior deviations).
  double rms(const FittedExplanation& fit, const Eigen::MatrixXd& more = {}) const;

 private:
  const PreparedCampaign& prepared_;
  std::vector<int> fold_of_row_;
  std::vector<bool> compared_;  // of each row
  int folds_;
};

// The shares of the held-out gap that go with single causes. The gap is what re-tuning leaves above the
// floor, r(nothing) - 1, or what the best explanation closes, if that is more. A cause alone closes
// r(nothing) - r(cause). In a pair it has the mean of what it closes first and what it closes after the
// other, so that the shares of both add up to what the pair closes [Shapley 1953].
class ClosedShares {
 public:
  ClosedShares(const LinearHeldOut& held_out, const ExplanationSearch& search);
  // Of a cause in the most probable explanation that has it; of one that was not fitted by its derivatives
  // beside the re-tuned parameters. Within 0 and 1.
  double of(const std::string& cause) const;

 private:
  using Names = std::set<std::string>;
  double rms_of(const Names& names) const;  // where it was not fitted, that of nothing

  const LinearHeldOut& held_out_;
  const ExplanationSearch& search_;
  std::map<Names, double> rms_;
  double nothing_ = 0.0, gap_ = 0.0;
};

// The sum of the probabilities of all sets that have the effect.
double marginal_probability(std::span<const ComparedSet> sets, const std::string& effect);

// Of every effect in the library, the most probable first.
std::vector<EffectMarginal> effect_marginals(std::span<const std::string> library,
                                             const ExplanationSearch& search, const ClosedShares& shares);

}  // namespace slipway::gap
