#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/progress.h"
#include "core/result.h"
#include "gap/diagnosis/model/noise_model.h"
#include "gap/diagnosis/search/discrepancy_term.h"
#include "gap/diagnosis/search/explanation.h"

namespace slipway::gap {

struct SearchOptions {
  std::vector<std::string> withheld;  // effects that are not looked for
  int most_refitted = 8;              // effects that are fitted in full
  int most_paired = 4;                // of those, whose pairs are looked for
  int most_seconds = 3;               // of each of those
  // An effect smaller than this share of its usual size (the deviation of its prior) is not worth a name: it
  // is how one simulator's numerics differ from another's.
  double least_size = 0.3;
  bool something_else = true;   // the wildcard competes; without it for ablations
  bool whole_evidence = false;  // believed as it stands, for ablations; see weigh
  std::size_t threads = 0;
};

// A set of effects that was compared. Its fit is one of ExplanationSearch::fits.
struct Candidate {
  std::vector<std::string> effects;  // in the order of its hypothesis; empty: none
  bool with_unknown = false;         // something else besides
  std::size_t fit = 0;
  double log_evidence = 0.0;  // the wildcard's part among it
  double log_prior = 0.0;
  double probability = 0.0;
};

// An effect's linear score at the null: how much the logarithm of the evidence would rise, by variant.
struct ScreenedVariant {
  EffectVariant variant;
  double gain = 0.0;
  Eigen::VectorXd signature;  // whitened response of its strongest field, nuisances projected out
  double kept_share = 0.0;    // of the signature's length that nuisances don't take
  double visibility = 0.0;  // length of what its first field's prior deviation does, nuisances projected out
};

struct ExplanationSearch {
  std::vector<FittedExplanation> fits;    // [0] is the null
  std::vector<Candidate> candidates;      // most probable first
  std::vector<ScreenedVariant> screened;  // best first
};

// Screens every variant at the null by its projected signature, fits the best in full, alone and in pairs,
// and weighs them against each other, nothing, and something else. `null` is fitted already, under `noise`.
// What was `found_before` under another noise competes again, from where it stood.
Result<ExplanationSearch> search_explanations(const DriveCampaign& campaign, const WindowModel& model,
                                              const NoiseModel& noise, FittedExplanation null,
                                              const DiscrepancyTerm& discrepancy,
                                              const SearchOptions& options, Progress& progress,
                                              std::span<const FittedExplanation> found_before = {});

// An oracle's: the effects that are not withheld are at work, all of them (two at most), and nothing else is
// compared.
Result<ExplanationSearch> fit_given_explanation(const DriveCampaign& campaign, const WindowModel& model,
                                                const NoiseModel& noise, FittedExplanation null,
                                                const DiscrepancyTerm& discrepancy,
                                                const SearchOptions& options, Progress& progress,
                                                std::span<const FittedExplanation> found_before = {});

// The candidates' probabilities from evidence and prior. The logarithm of the evidence is
// believed by a share, since no simulator is exact: mostly by one, and, as answers of sealed campaigns that
// were sure and wrong ask for, now and then by a tenth of it.
void weigh(std::span<Candidate> candidates, const SearchOptions& options);

// The fits of the most probable sets of effects, at most so many.
std::vector<FittedExplanation> most_probable_fits(const ExplanationSearch& search, std::size_t most);

}  // namespace slipway::gap
