#pragma once

#include <cstddef>
#include <vector>

#include "gap/diagnosis/held_out/held_out.h"
#include "gap/diagnosis/search/selection.h"

namespace slipway::gap {

// The correction that is reported, [0], and those that would have been chosen had other drives been made.
struct CorrectionChoice {
  std::vector<Correction> corrections;
  std::vector<std::size_t> of_resample;  // which of them; empty: always the first
};

// `reported` and `most_believed` are candidates of the search: the one whose effects are all named, and the
// one that the names were taken from. Sets of effects that less than HeldOutOptions::min_chosen_share of the
// resamples choose count as the reported one.
CorrectionChoice choose_corrections(const PreparedCampaign& prepared, const ExplanationSearch& search,
                                    const SelectionBootstrap& selection, std::size_t reported,
                                    std::size_t most_believed, const DiagnosisOptions& options);

}  // namespace slipway::gap
