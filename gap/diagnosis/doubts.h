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

// Takes an answer back to `unknown` where
//   1. far more than the floor is left on drives held out of the fit,
//   2. a parameter lies at the end of what it may be,
//   3. a closure is beyond VerdictOptions::max_closure_shift, or a soil beside named effects beyond
//      max_soil_shift,
//   4. named effects close less than min_share_beside_form of the gap together, or
//   5. a scale of the drives' scatter is beyond max_scatter.
// Effects keep their names in a partial answer where they may stand beside something unknown (naming.h). In
// cases 3 to 5 they do so if they are as good as certain (min_probability_beside_form and
// min_share_beside_form), or one of them is and closes min_partial_share by itself; and in case 5 if they
// close min_partial_share together. `reported`: the
// fit that the answer stands for; `scatter`: the scale furthest above belief, nothing where a reference told
// of it; d has its `gap`.
void doubt_what_leaves_a_gap(const FittedExplanation& reported, const std::optional<ScaleOffBelief>& scatter,
                             const VerdictOptions& options, Diagnosis& d);

}  // namespace slipway::gap
