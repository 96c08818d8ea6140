#include "gap/diagnosis/held_out/correction_choice.h"

#include <map>

namespace slipway::gap {

CorrectionChoice choose_corrections(const PreparedCampaign& prepared, const ExplanationSearch& search,
                                    const SelectionBootstrap& selection, std::size_t reported,
                                    std::size_t most_believed, const DiagnosisOptions& options) {
  const auto refit = [&](std::size_t candidate) {
    return refitted(prepared, search.fits[search.candidates[candidate].fit], options);
  };
  CorrectionChoice choice{{refit(reported)}, {}};
  // Where resamples choose what was chosen of all drives, they give it the same names.
  std::map<std::size_t, std::size_t> correction_of{{reported, 0}, {most_believed, 0}};
  for (std::size_t c = 0; c < selection.share.size(); ++c) {
    if (correction_of.contains(c) || selection.share[c] == 0.0) continue;
    const Candidate& candidate = search.candidates[c];
    const bool corrects = !candidate.unknown() && !candidate.effects.empty();
    if (corrects && selection.share[c] < options.held_out.min_chosen_share) {
      correction_of[c] = 0;
      continue;
    }
    correction_of[c] = choice.corrections.size();
    choice.corrections.push_back(corrects ? refit(c) : uncorrected());
  }
  for (const std::size_t chosen : selection.chosen) choice.of_resample.push_back(correction_of[chosen]);
  return choice;
}

}  // namespace slipway::gap
