#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/progress.h"
#include "core/result.h"
#include "gap/diagnosis/model/noise_model.h"
#include "gap/diagnosis/search/discrepancy_term.h"
#include "gap/diagnosis/search/explanation.h"

namespace slipway::gap {

// A set of effects that was compared. Its fit is one of ExplanationSearch::fits.
struct Candidate {
  // In the order of its hypothesis; empty: none. A cause from outside is among them.
  std::vector<std::string> effects;
  bool with_unknown = false;  // something else besides
  bool outside = false;       // a cause from outside is among the effects
  std::size_t fit = 0;
  double log_evidence = 0.0;  // the discrepancy term's part among it
  NoiseScales scatter;        // of the drives beside its fit
  double log_prior = 0.0;
  // Of each of its effects: logarithms of the evidence that its other variants have over the fitted one's, 0
  // at most. Each variant has the same prior, log_prior.
  std::vector<std::vector<double>> other_variants;
  double probability = 0.0;

  // Whether it says that something is at work that the library has no name for.
  bool unknown() const { return with_unknown || outside; }
};
// Its effects that are of the library, and its causes from outside.
std::vector<std::string> library_effects_of(const Candidate& candidate);
std::vector<std::string> outside_causes_of(const Candidate& candidate);

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

// The candidates' probabilities from evidence and prior: P = sum_k weight_k exp(share_k E + log prior) / Z_k,
// each share of the log evidence E normalised over the candidates by itself.
void weigh(std::span<Candidate> candidates, const EvidenceOptions& options);
// Weighs them and puts the most probable first.
void rank(std::span<Candidate> candidates, const EvidenceOptions& options);

// What a set of effects is believed by before the drives (natural logarithms): alone, and with something else
// besides. A set's share of its prior is divided by the number of effects in the library, or of their pairs.
struct LogPrior {
  double alone = 0.0, with_something_else = 0.0;
};
LogPrior log_prior_of_nothing(const PriorOptions& options);
LogPrior log_prior_of_one(const PriorOptions& options, double effects);
LogPrior log_prior_of_two(const PriorOptions& options, double effects);
// One of so many causes from outside; the same beside an effect of the library.
LogPrior log_prior_of_outside(const PriorOptions& options, double causes);
LogPrior log_prior_of_one_and_outside(const PriorOptions& options, double effects, double causes);

// Whether each effect of a fit is at work by a good part of its usual size.
bool worth_naming(const FittedExplanation& fit, double min_size);

// Whether what a fit re-tunes had to go so far from what was believed, in prior deviations.
bool went_far(const FittedExplanation& fit, double max_shift);

// The fits of the most probable sets of effects, at most so many.
std::vector<FittedExplanation> most_probable_fits(const ExplanationSearch& search, std::size_t most);

}  // namespace slipway::gap
