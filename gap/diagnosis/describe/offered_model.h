#pragma once

#include "gap/diagnosis/result/result.h"
#include "gap/diagnosis/search/diagnosis_options.h"
#include "gap/diagnosis/search/explanation_search.h"

namespace slipway::gap {

// Offers the model to plan with (Diagnosis::model, model_effects and left_open). With effects named it is
// offered where it predicts drives held out of the fit better than the re-tuned model alone
// (`log_density_gain` a drive > 0), and a note says so where not; beside something unknown, where it predicts
// them better than the nominal one, with a note either way; where re-tuned parameters explain the drives,
// always. Where no gap was found the nominal model stands. `reported`: the fit that the verdict speaks of.
void offer_model(const FittedExplanation& reported, double log_density_gain, const HeldOutOptions& options,
                 Diagnosis& d);

}  // namespace slipway::gap
