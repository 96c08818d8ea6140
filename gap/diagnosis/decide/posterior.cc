#include "gap/diagnosis/decide/posterior.h"

#include <algorithm>
#include <span>

#include "gap/diagnosis/search/candidate.h"

namespace slipway::gap {

double SearchRecord::share_of(const std::string& cause) const {
  const auto own =
      std::find_if(causes.begin(), causes.end(), [&](const Cause& c) { return c.name == cause; });
  return own == causes.end() ? 0.0 : own->share;
}

double evidence_share(const DiagnosisOptions& options, bool with_reference) {
  return with_reference ? options.evidence.share * options.reference.evidence_share : options.evidence.share;
}

void weigh(SearchRecord& record, double share) {
  rank(std::span(record.explanations), share);
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
