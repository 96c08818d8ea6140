#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/progress.h"
#include "core/result.h"
#include "gap/diagnosis/model/noise_model.h"
#include "gap/diagnosis/search/candidate.h"
#include "gap/diagnosis/search/discrepancy_term.h"
#include "gap/diagnosis/search/explanation.h"

namespace slipway::gap {

// An effect's linear score at the null: how much the logarithm of the evidence would rise, by variant.
struct ScreenedVariant {
  EffectVariant variant;
  double gain = 0.0;
  Eigen::VectorXd signature;  // whitened response of its strongest field, nuisances projected out
  double kept_share = 0.0;    // of the signature's length that nuisances don't take
  double visibility = 0.0;  // length of what its first field's prior deviation does, nuisances projected out
  Eigen::MatrixXd reach;    // see ScreenedEffect
  Eigen::MatrixXd columns;  // derivatives of every observation at the null, by prior deviations
  std::vector<std::size_t> taken_by;  // see ScreenedEffect
};

struct ExplanationSearch {
  std::vector<FittedExplanation> fits;    // [0] is the null
  std::vector<Candidate> candidates;      // most probable first
  std::vector<ScreenedVariant> screened;  // of the library, best first
  std::vector<ScreenedVariant> screened_outside;
};

// Screens every variant at the null by its projected signature, fits the best in full, alone and in pairs,
// and weighs them against each other, nothing, and something else. `null` is fitted already, under `noise`.
// What was `found_before` under another noise competes again, from where it stood.
Result<ExplanationSearch> search_explanations(const DriveCampaign& campaign, const WindowModel& model,
                                              const NoiseModel& noise, FittedExplanation null,
                                              const DiscrepancyTerm& discrepancy,
                                              const DiagnosisOptions& options, Progress& progress,
                                              std::span<const FittedExplanation> found_before = {});

// An oracle's: the effects that are not withheld are at work, all of them (two at most), and nothing else is
// compared.
Result<ExplanationSearch> fit_given_explanation(const DriveCampaign& campaign, const WindowModel& model,
                                                const NoiseModel& noise, FittedExplanation null,
                                                const DiscrepancyTerm& discrepancy,
                                                const DiagnosisOptions& options, Progress& progress,
                                                std::span<const FittedExplanation> found_before = {});

// Whether each effect of a fit is at work by a good part of its usual size.
bool worth_naming(const FittedExplanation& fit, double min_size);

// The fits of the most probable sets of effects, at most so many, and of all parts of the first: the shares
// of its effects are told by those.
std::vector<FittedExplanation> most_probable_fits(const ExplanationSearch& search, std::size_t most);

}  // namespace slipway::gap
