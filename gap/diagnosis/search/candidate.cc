#include "gap/diagnosis/search/candidate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "gap/diagnosis/model/outside_cause.h"

namespace slipway::gap {
namespace {

constexpr std::array kWholeEvidence{EvidenceShare{1.0, 1.0}};

double log_sum_exp(const std::vector<double>& values) {
  const double most = *std::max_element(values.begin(), values.end());
  double sum = 0.0;
  for (const double v : values) sum += std::exp(v - most);
  return most + std::log(sum);
}

bool says_nothing(const Candidate& c) {
  return c.effects.empty() && !c.with_unknown;
}

// By how much the best set with something in it has more evidence than nothing: 0 at least, and where nothing
// was not compared.
double evidence_of_missing(std::span<const Candidate> candidates) {
  double most = 0.0;
  for (const Candidate& c : candidates) most = std::max(most, evidence_over_nothing(c, candidates));
  return most;
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
  return {std::log(options.one_effect / effects), std::log(options.one_and_something_else / effects)};
}

LogPrior log_prior_of_two(const PriorOptions& options, double effects) {
  const double pairs = std::max(1.0, 0.5 * effects * (effects - 1.0));
  const double alone = std::log(options.two_effects / pairs);
  return {alone, alone + options.pair_beside_something_else_log};
}

LogPrior log_prior_of_outside(const PriorOptions& options, double causes) {
  const double alone = std::log(options.one_outside / causes);
  return {alone, alone + options.pair_beside_something_else_log};
}

LogPrior log_prior_of_one_and_outside(const PriorOptions& options, double effects, double causes) {
  const double alone = std::log(options.one_and_one_outside / (effects * causes));
  return {alone, alone + options.pair_beside_something_else_log};
}

void weigh(std::span<Candidate> candidates, const EvidenceOptions& options) {
  if (candidates.empty()) return;
  for (Candidate& c : candidates) c.probability = 0.0;
  const std::span<const EvidenceShare> shares =
      options.whole ? std::span<const EvidenceShare>(kWholeEvidence) : options.shares;
  const double further = options.whole ? 0.0 : (options.of_missing - 1.0) * evidence_of_missing(candidates);
  for (const EvidenceShare& belief : shares) {
    std::vector<double> weights;
    for (const Candidate& c : candidates) {
      double weight = belief.share * (c.log_evidence + (says_nothing(c) ? 0.0 : further)) + c.log_prior;
      for (const std::vector<double>& of_effect : c.other_variants) {
        double variants = 1.0;
        for (const double less : of_effect) variants += std::exp(belief.share * less);
        weight += std::log(variants);
      }
      weights.push_back(weight);
    }
    const double all = log_sum_exp(weights);
    for (std::size_t i = 0; i < weights.size(); ++i)
      candidates[i].probability += belief.weight * std::exp(weights[i] - all);
  }
}

void rank(std::span<Candidate> candidates, const EvidenceOptions& options) {
  weigh(candidates, options);
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.probability > b.probability; });
}

}  // namespace slipway::gap
