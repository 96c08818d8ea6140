#pragma once

#include "gap/diagnosis/result/result.h"
#include "gap/diagnosis/search/diagnosis_options.h"
#include "gap/diagnosis/search/explanation_search.h"

namespace slipway::gap {

// Offers the model to plan with (Diagnosis::model, model_effects and left_open), where it predicts drives
// held out of the fit better than the nominal one, or notes why not. `reported`: the fit that the verdict
// speaks of; `log_density_gain`: a drive, of the correction over the re-tuned model.
void offer_model(const FittedExplanation& reported, double log_density_gain, const HeldOutOptions& options,
                 Diagnosis& d);

}  // namespace slipway::gap
