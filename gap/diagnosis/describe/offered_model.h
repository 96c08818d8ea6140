#pragma once

#include "gap/diagnosis/result/result.h"
#include "gap/diagnosis/search/diagnosis_options.h"
#include "gap/diagnosis/search/explanation_search.h"

namespace slipway::gap {

// Offers the model to plan with (Diagnosis::model, model_effects and left_open), whatever the verdict: where
// on drives held out of the fit no channel is predicted worse by it than by the nominal model, and one
// better, and no re-tuned parameter stands at an end of what it may be. With effects named it must also tell
// held-out drives better than re-tuned parameters alone (`log_density_gain` a drive > 0). A note says why
// none is offered. Where no gap was found the nominal model stands. `reported`: the fit that the verdict
// speaks of.
void offer_model(const FittedExplanation& reported, double log_density_gain, const HeldOutOptions& options,
                 Diagnosis& d);

}  // namespace slipway::gap
