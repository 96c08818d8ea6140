#include "gap/diagnosis/decide/posterior.h"

#include <algorithm>
#include <cmath>

namespace slipway::gap {

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

void weigh(SearchRecord& record, double share) {
  std::vector<double> weights;
  for (const SearchRecord::Explanation& e : record.explanations)
    weights.push_back(log_weight(e.log_evidence, e.log_prior, e.other_variants, share));
  const std::vector<double> probabilities = normalised(weights);
  for (std::size_t i = 0; i < probabilities.size(); ++i)
    record.explanations[i].probability = probabilities[i];
  std::stable_sort(record.explanations.begin(), record.explanations.end(),
                   [](const auto& a, const auto& b) { return a.probability > b.probability; });
}

Marginals marginals_of(const SearchRecord& record) {
  Marginals marginals;
  for (const SearchRecord::Explanation& e : record.explanations) {
    for (const std::string& effect : e.effects) marginals.of_cause[effect] += e.probability;
    for (const std::string& cause : e.outside) marginals.of_cause[cause] += e.probability;
    if (e.unknown()) marginals.unknown += e.probability;
    if (!e.unknown() && e.effects.empty()) marginals.nothing += e.probability;
  }
  return marginals;
}

}  // namespace slipway::gap
