#include "gap/diagnosis/search/candidate.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "gap/diagnosis/model/outside_cause.h"

namespace slipway::gap {
namespace {

bool says_nothing(const Candidate& c) {
  return c.effects.empty() && !c.with_unknown;
}

// A prior of something known, and of the same with something else besides: as probable as something else is
// alone.
LogPrior beside_something_else(const PriorOptions& options, double log_alone) {
  return {log_alone, log_alone + std::log(options.something_else)};
}

}  // namespace

double evidence_over_nothing(const Candidate& candidate, std::span<const Candidate> candidates) {
  const auto nothing = std::find_if(candidates.begin(), candidates.end(), says_nothing);
  return nothing == candidates.end() ? 0.0 : candidate.log_evidence - nothing->log_evidence;
}

std::vector<std::string> library_effects_of(const Candidate& candidate) {
  std::vector<std::string> names;
  std::copy_if(candidate.effects.begin(), candidate.effects.end(), std::back_inserter(names),
               [](const std::string& name) { return !is_outside(name); });
  return names;
}

std::vector<std::string> outside_causes_of(const Candidate& candidate) {
  std::vector<std::string> names;
  std::copy_if(candidate.effects.begin(), candidate.effects.end(), std::back_inserter(names), is_outside);
  return names;
}

LogPrior log_prior_of_nothing(const PriorOptions& options) {
  return {std::log(options.nothing), std::log(options.something_else)};
}

LogPrior log_prior_of_one(const PriorOptions& options, double effects) {
  return beside_something_else(options, std::log(options.one_effect / effects));
}

LogPrior log_prior_of_two(const PriorOptions& options, double effects) {
  const double pairs = std::max(1.0, 0.5 * effects * (effects - 1.0));
  return beside_something_else(options, std::log(options.two_effects / pairs));
}

LogPrior log_prior_of_outside(const PriorOptions& options, double causes) {
  return beside_something_else(options, std::log(options.one_outside / causes));
}

LogPrior log_prior_of_one_and_outside(const PriorOptions& options, double effects, double causes) {
  return beside_something_else(options,
                               std::log(options.one_effect / effects * options.one_outside / causes));
}

double log_weight(double log_evidence, double log_prior, std::span<const std::vector<double>> other_variants,
                  double share) {
  double weight = share * log_evidence + log_prior;
  for (const std::vector<double>& of_cause : other_variants) {
    double variants = 1.0;
    for (const double less : of_cause) variants += std::exp(share * less);
    weight += std::log(variants);
  }
  return weight;
}

std::vector<double> normalised(std::span<const double> log_weights) {
  std::vector<double> weights(log_weights.begin(), log_weights.end());
  if (weights.empty()) return weights;
  const double most = *std::max_element(weights.begin(), weights.end());
  double sum = 0.0;
  for (double& w : weights) sum += w = std::exp(w - most);
  for (double& w : weights) w /= sum;
  return weights;
}

}  // namespace slipway::gap
