#pragma once

#include <optional>

#include "gap/diagnosis/diagnosis.h"
#include "gap/diagnosis/model/noise_model.h"
#include "gap/diagnosis/search/explanation.h"

// What drives held out of the fit, and the scatter between drives, say against a verdict.
namespace slipway::gap {

// Not certain of effects that predicted harsh drives worse than re-tuned parameters did, by more than chance.
void doubt_what_does_not_extrapolate(const VerdictOptions& options, Diagnosis& d);

// Effects with which drives held out of the fit are told no better than re-tuned (their log density gains
// nothing) are not named, however probable they are on the drives that they were fitted to.
void withdraw_what_tells_no_better(double log_density_gain, Diagnosis& d);

// An answer that leaves far more than the floor on drives held out of the fit, or that needs a parameter at
// the end of what it may be, is none: the cause is unknown, and nothing is named unless it may stand beside
// something unknown (see naming.h); then the answer is a partial one. So is an answer beside which drives
// would scatter by more than anyone believed: there what is named stands if it closes
// VerdictOptions::min_partial_share together. `reported`: the fit that the answer stands for; `scatter`: the
// scale furthest above belief, where no reference told of it; d has its `gap`.
void doubt_what_leaves_a_gap(const FittedExplanation& reported, const std::optional<ScaleOffBelief>& scatter,
                             const VerdictOptions& options, Diagnosis& d);

}  // namespace slipway::gap
