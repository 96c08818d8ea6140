#pragma once

#include <map>
#include <string>

#include "gap/diagnosis/decide/search_record.h"
#include "gap/diagnosis/search/diagnosis_options.h"

namespace slipway::gap {

// The share of the log evidence that is believed: less of it where a reference told what is healthy.
double evidence_share(const DiagnosisOptions& options, bool with_reference);

// Writes each explanation's probability, see search/candidate.h; the most probable comes first.
void weigh(SearchRecord& record, double share);

// Sums over explanations.
struct Marginals {
  std::map<std::string, double> of_cause;  // effects of the library and causes from outside
  double nothing = 0.0;                    // nothing is missing
  double unknown = 0.0;                    // something that the library has no name for is at work
};
Marginals marginals_of(const SearchRecord& record);

}  // namespace slipway::gap
