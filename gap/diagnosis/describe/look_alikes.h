#pragma once

#include <vector>

#include "gap/diagnosis/result/result.h"
#include "gap/diagnosis/search/diagnosis_options.h"
#include "gap/diagnosis/search/explanation_search.h"

namespace slipway::gap {

// Effects of the library whose traces lie within VerdictOptions::max_angle_deg of each other, re-tuning
// projected out, the nearest first.
std::vector<ConfusablePair> confusable_pairs(const ExplanationSearch& search, const VerdictOptions& options);

// The class of each effect: what it can't be told from by these drives. A pair of effects is of one class
// where it is confusable, an effect and a cause from outside by the same angle. An effect is of the class of
// the re-tuned parameters where these drives would not surely have shown it at its usual size beside them
// (VerdictOptions::surely_seen), the parameters taking most of its trace.
std::vector<LookAlike> look_alikes(const ExplanationSearch& search, const VerdictOptions& options);

}  // namespace slipway::gap
