#include "gap/diagnosis/held_out/search_record_of.h"

#include <map>
#include <set>

namespace slipway::gap {
namespace {

SearchRecord::Fit record_of_fit(const FittedExplanation& fit, double held_out_rms) {
  // Deviations from what was believed beyond which an end counts as far.
  constexpr double kFarEnd = 4.0;
  SearchRecord::Fit record{.held_out_rms = held_out_rms, .shifts = {}};
  for (std::size_t p = 0; p < fit.hypothesis.nuisance_count(); ++p) {
    const Parameter& parameter = fit.hypothesis.parameters()[p];
    record.shifts.push_back({parameter.name, (fit.x[p] - parameter.neutral) / parameter.usual_std,
                             parameter.lowest < parameter.neutral - kFarEnd * parameter.std &&
                                 parameter.neutral + kFarEnd * parameter.std < parameter.highest});
  }
  return record;
}

}  // namespace

SearchRecord record_of(const ExplanationSearch& search, const ClosedShares& shares,
                       std::span<const std::string> library) {
  SearchRecord record;
  // Fits that were given up compete in no explanation.
  std::map<std::size_t, std::size_t> place_of_fit;
  const auto place_of = [&](std::size_t fit, const std::vector<std::string>& causes) {
    const auto [place, is_new] = place_of_fit.try_emplace(fit, record.fits.size());
    if (is_new)
      record.fits.push_back(record_of_fit(search.fits[fit], shares.rms_of({causes.begin(), causes.end()})));
    return place->second;
  };
  place_of(0, {});
  std::set<std::string> from_outside;
  for (const Candidate& c : search.candidates) {
    const std::vector<std::string> outside = outside_causes_of(c);
    from_outside.insert(outside.begin(), outside.end());
    record.explanations.push_back({library_effects_of(c), outside, c.with_unknown, place_of(c.fit, c.effects),
                                   evidence_over_nothing(c, search.candidates), c.log_prior, c.other_variants,
                                   c.probability});
  }
  std::vector<std::string> causes(library.begin(), library.end());
  causes.insert(causes.end(), from_outside.begin(), from_outside.end());
  for (const std::string& cause : causes) record.causes.push_back({cause, shares.of(cause)});
  return record;
}

}  // namespace slipway::gap
