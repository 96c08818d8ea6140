#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "gap/diagnosis/decide/adequacy.h"
#include "gap/diagnosis/decide/posterior.h"
#include "gap/diagnosis/decide/search_record.h"
#include "gap/diagnosis/search/diagnosis_options.h"

namespace slipway::gap {

enum class Verdict { kNoGap, kNotDetected, kParameters, kEffects, kEffectSet, kUnknown, kInsufficient };
std::string_view name_of(Verdict verdict);  // "no_gap", ...
inline bool names_effects(Verdict verdict) {
  return verdict == Verdict::kEffects || verdict == Verdict::kEffectSet;
}
// Whether it says that nothing is missing from the model, or nothing that these drives show.
inline bool finds_nothing_missing(Verdict verdict) {
  return verdict == Verdict::kNoGap || verdict == Verdict::kNotDetected || verdict == Verdict::kParameters;
}

// The answer of least expected loss over what a search found, and what it was made from.
//
//   q_e  the calibrated probability that effect e is at work (calibration.h)
//   U(S) = sum over e in S of q_e missed_name - (1 - q_e) wrong_name, the loss that naming S saves
//
// Named is the compared set S of greatest U(S), if that is above 0. Where the wheel model is not adequate
// (adequacy.h), effects that change what the ground does to all wheels are one class, "another wheel law",
// and none of them is named. Beside names, something unknown is said to be at work where it is more probable
// than not, or the model is not adequate. Without names the answer is `unknown` where that loses less than an
// answer that nothing is missing, by false_alarm and missed_alarm, or the model is not adequate, or the
// drives have changed along their way. The
// probability that something is missing is that of all that is unknown and of each set of effects by so much
// as its effects would be at work, were they certain, by the share of the gap that they close: what closes
// nothing is not missing. Printed probabilities are those of the posterior, whatever is decided.
struct Decision {
  Verdict verdict = Verdict::kUnknown;
  std::vector<std::string> names;
  bool partial = false;  // names are given, and something unexplained remains beside them
  bool adequate = true;
  Adequacy adequacy;
  Marginals marginals;
  std::map<std::string, double> calibrated;  // q of each effect of the library
  // Explanations of the record. `answer`: the one that is reported, with exactly the names and nothing
  // unknown where that was compared; `beside`: the most probable one with these names and something unknown,
  // or the answer where there is none.
  std::size_t answer = 0, beside = 0;
  // That exactly the named effects of the library are at work, with something unknown or without.
  double set_probability = 0.0;
  double missing_probability = 0.0;  // that something is missing
};
Decision decide(const SearchRecord& record, double evidence_share, const DecisionOptions& options);

// Whether an effect could be how another wheel law differs from this one: it changes what ground or gears do
// to all wheels alike, wherever they are and however warm they turn.
bool may_be_wheel_law(const std::string& effect);

}  // namespace slipway::gap
