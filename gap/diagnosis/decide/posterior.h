#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "gap/diagnosis/decide/search_record.h"

namespace slipway::gap {

// Probabilities of the compared explanations: P(m) proportional to p(m) exp(share E_m), of which each variant
// of a cause takes its part. No simulator is exact, so that only a share of the log evidence E is believed: a
// coarsened posterior [Miller and Dunson 2019].

// The logarithm of an explanation's weight, up to a constant of all of them.
double log_weight(double log_evidence, double log_prior, std::span<const std::vector<double>> other_variants,
                  double share);

// Weights that add up to 1.
std::vector<double> normalised(std::span<const double> log_weights);

// Writes each explanation's probability; the most probable comes first.
void weigh(SearchRecord& record, double share);

// Sums over explanations.
struct Marginals {
  std::map<std::string, double> of_cause;  // effects of the library and causes from outside
  double nothing = 0.0;                    // nothing is missing
  double unknown = 0.0;                    // something that the library has no name for is at work
};
Marginals marginals_of(const SearchRecord& record);

}  // namespace slipway::gap
