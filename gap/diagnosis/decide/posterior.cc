#include "gap/diagnosis/decide/posterior.h"

#include <algorithm>
#include <vector>

#include "gap/diagnosis/search/candidate.h"

namespace slipway::gap {

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
