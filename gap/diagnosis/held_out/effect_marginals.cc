#include "gap/diagnosis/held_out/effect_marginals.h"

#include <algorithm>

#include "gap/diagnosis/decide/posterior.h"
#include "gap/diagnosis/model/outside_cause.h"

namespace slipway::gap {

ClosedShares::ClosedShares(Rms rms, const ExplanationSearch& search)
    : rms_(std::move(rms)), search_(search), nothing_(rms_(search.fits[0], {})) {
  for (const Candidate& c : search.candidates) {
    const auto [place, is_new] = rms_with_.try_emplace(Names(c.effects.begin(), c.effects.end()), 0.0);
    if (is_new) place->second = rms_(search.fits[c.fit], {});
    floor_ = std::min(floor_, place->second);
  }
  gap_ = nothing_ - floor_;
}

double ClosedShares::rms_of(const Names& names) const {
  const auto known = rms_with_.find(names);
  return known == rms_with_.end() ? nothing_ : known->second;
}

ClosedShares::Names ClosedShares::explanation_with(const std::string& cause) const {
  for (const Candidate& c : search_.candidates)
    if (std::find(c.effects.begin(), c.effects.end(), cause) != c.effects.end())
      return {c.effects.begin(), c.effects.end()};
  return {};
}

double ClosedShares::of(const std::string& cause) const {
  if (!(gap_ > 0.0)) return 0.0;
  double closed = 0.0;
  if (const Names all = explanation_with(cause); !all.empty()) {
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

std::vector<EffectMarginal> effect_marginals(const SearchRecord& record) {
  const Marginals probabilities = marginals_of(record);
  std::vector<EffectMarginal> marginals;
  for (const SearchRecord::Cause& cause : record.causes) {
    if (is_outside(cause.name)) continue;
    const auto probability = probabilities.of_cause.find(cause.name);
    marginals.push_back(
        {.name = cause.name,
         .probability = probability == probabilities.of_cause.end() ? 0.0 : probability->second,
         .closed_share = cause.share});
  }
  std::stable_sort(marginals.begin(), marginals.end(), [](const EffectMarginal& a, const EffectMarginal& b) {
    return a.probability != b.probability ? a.probability > b.probability : a.closed_share > b.closed_share;
  });
  return marginals;
}

}  // namespace slipway::gap
