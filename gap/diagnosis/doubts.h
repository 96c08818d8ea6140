#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "gap/diagnosis/diagnosis.h"
#include "gap/diagnosis/model/noise_model.h"
#include "gap/diagnosis/search/explanation.h"

// What drives held out of the fit, the scatter between drives and what was believed of soil and laws say
// against a verdict.
namespace slipway::gap {

// Not certain of effects that predicted harsh drives worse than re-tuned parameters did, by more than chance.
void doubt_what_does_not_extrapolate(const VerdictOptions& options, Diagnosis& d);

// Effects with which drives held out of the fit are told no better than re-tuned (their log density gains
// nothing) are not named, however probable they are on the drives that they were fitted to; but those that
// close most of the gap (min_partial_share) by the fits' own robust loss are, where they have
// min_partial_probability or their log evidence over nothing is strong_evidence.
void withdraw_what_tells_no_better(double log_density_gain, double log_evidence,
                                   const VerdictOptions& options, Diagnosis& d);

// What is held against an answer besides its probability.
struct ReportedAnswer {
  const FittedExplanation& fit;           // that it stands for
  double closed_share = 0.0;              // of the held-out gap, by all that it names
  double log_evidence = 0.0;              // over that of nothing missing
  std::optional<ScaleOffBelief> scatter;  // furthest above belief; none where a reference told of it
};

// The closure of the wheel law that an explanation bends furthest from what was believed of it, in usual
// deviations, with their sign. Closures whose ends are near, as with a reference, do not count.
struct ClosureShift {
  std::string closure;
  double deviations = 0.0;
};
ClosureShift furthest_closure(const FittedExplanation& fit);

// What an explanation bends beyond belief, in words: a closure beyond VerdictOptions::max_closure_shift,
// which only another wheel law would ask for, or a soil beside effects beyond max_soil_shift. Nothing where
// all are within.
std::optional<std::string> beyond_belief(const FittedExplanation& fit, std::span<const std::string> effects,
                                         const VerdictOptions& options);

// The drives' own scatter, in words, where it is beyond VerdictOptions::max_scatter.
std::optional<std::string> scatter_beyond_belief(const std::optional<ScaleOffBelief>& scatter,
                                                 const VerdictOptions& options);

// What is held against an answer.
struct Doubt {
  std::string why;
  bool of_a_gap = false;  // and not of belief
  // Of the named effects those that may be named beside something unknown all the same, and the others.
  std::vector<std::string> standing, fallen;
};

// An answer is in doubt where
//   1. far more than the floor is left on drives held out of the fit,
//   2. a parameter lies at the end of what it may be,
//   3. a closure is beyond VerdictOptions::max_closure_shift, or a soil beside named effects, none of which
//      acts at a place, beyond max_soil_shift,
//   4. what is named closes less than min_named_share of the gap for all its strong_evidence, or
//   5. a scale of the drives' scatter is beyond max_scatter.
// Effects that may be named beside something unknown (stands_beside_unknown) stand; where 3 or 5 holds none
// that may be how another wheel law differs, for that is what is asked for there. In case 5 all stand that
// close min_partial_share together, each being more probable than not, or having min_partial_probability
// where other sets were alike. In case 4 none does. Nothing where the answer is not in doubt, or says already
// that something is unknown. d has its `gap`.
std::optional<Doubt> doubt_of(const ReportedAnswer& answer, const VerdictOptions& options,
                              const Diagnosis& d);

// Takes the answer back to a partial one with the names that stand, or to `unknown` where there are none.
// What d has of drives held out is to be without the names that fell where others stand.
void apply_doubt(const Doubt& doubt, const VerdictOptions& options, Diagnosis& d);

// Where readings are implausible, as these notes say (reading_plausibility.h), that nothing is missing is
// taken back to `unknown`: currents in mA agree with any model once they are taken to scatter by as much.
void doubt_readings(std::span<const std::string> implausible, const VerdictOptions& options, Diagnosis& d);

}  // namespace slipway::gap
