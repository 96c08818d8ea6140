#pragma once

#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "gap/diagnosis/decide/search_record.h"
#include "gap/diagnosis/result/result.h"
#include "gap/diagnosis/search/explanation_search.h"

namespace slipway::gap {

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

  // r of these causes together, as they were fitted; where they were not, that of nothing.
  using Names = std::set<std::string>;
  double rms_of(const Names& names) const;

 private:
  // The most probable explanation that has the cause; empty where it was not fitted.
  Names explanation_with(const std::string& cause) const;

  Rms rms_;
  const ExplanationSearch& search_;
  std::map<Names, double> rms_with_;
  double nothing_ = 0.0, floor_ = 1.0, gap_ = 0.0;
};

// Of every effect in the library, the most probable first.
std::vector<EffectMarginal> effect_marginals(const SearchRecord& record);

}  // namespace slipway::gap
