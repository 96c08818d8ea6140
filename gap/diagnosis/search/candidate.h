#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "gap/diagnosis/model/noise_model.h"
#include "gap/diagnosis/search/diagnosis_options.h"

namespace slipway::gap {

// A set of effects that was compared. Its fit is one of ExplanationSearch::fits.
struct Candidate {
  // In the order of its hypothesis; empty: none. A cause from outside is among them.
  std::vector<std::string> effects;
  bool with_unknown = false;  // something else besides
  bool outside = false;       // a cause from outside is among the effects
  std::size_t fit = 0;
  double log_evidence = 0.0;  // up to a constant of all candidates; the discrepancy term's part among it
  NoiseScales scatter;        // of the drives beside its fit
  double log_prior = 0.0;
  // Of each of its effects: logarithms of the evidence that its other variants have over the fitted one's, 0
  // at most. Each variant has the same prior, log_prior.
  std::vector<std::vector<double>> other_variants;
  double probability = 0.0;

  // Whether it says that something is at work that the library has no name for.
  bool unknown() const { return with_unknown || outside; }
};
// The logarithm of the evidence over that of nothing missing; 0 where nothing was not compared.
double evidence_over_nothing(const Candidate& candidate, std::span<const Candidate> candidates);

// Its effects that are of the library, and its causes from outside.
std::vector<std::string> library_effects_of(const Candidate& candidate);
std::vector<std::string> outside_causes_of(const Candidate& candidate);

// Probabilities of the compared explanations: P(m) proportional to p(m) exp(share E_m), of which each variant
// of a cause takes its part. No simulator is exact, so that only a share of the log evidence E is believed: a
// coarsened posterior [Miller and Dunson 2019].

// The logarithm of an explanation's weight, up to a constant of all of them.
double log_weight(double log_evidence, double log_prior, std::span<const std::vector<double>> other_variants,
                  double share);

// Weights that add up to 1.
std::vector<double> normalised(std::span<const double> log_weights);

// Writes the probabilities of candidates, or of what else has their evidence, prior and variants.
template <class Explanation>
void weigh(std::span<Explanation> explanations, double share) {
  std::vector<double> weights;
  for (const Explanation& e : explanations)
    weights.push_back(log_weight(e.log_evidence, e.log_prior, e.other_variants, share));
  const std::vector<double> probabilities = normalised(weights);
  for (std::size_t i = 0; i < probabilities.size(); ++i) explanations[i].probability = probabilities[i];
}
inline void weigh(std::span<Candidate> candidates, const EvidenceOptions& options) {
  weigh(candidates, options.share);
}
// Weighs them and puts the most probable first.
template <class Explanation>
void rank(std::span<Explanation> explanations, double share) {
  weigh(explanations, share);
  std::stable_sort(explanations.begin(), explanations.end(),
                   [](const Explanation& a, const Explanation& b) { return a.probability > b.probability; });
}
inline void rank(std::span<Candidate> candidates, const EvidenceOptions& options) {
  rank(candidates, options.share);
}

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

}  // namespace slipway::gap
