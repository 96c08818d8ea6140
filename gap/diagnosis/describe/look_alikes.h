#pragma once

#include <vector>

#include "gap/diagnosis/result/result.h"
#include "gap/diagnosis/search/diagnosis_options.h"
#include "gap/diagnosis/search/explanation_search.h"

namespace slipway::gap {

// Effects of the library that these drives hardly tell apart, the nearest first: the trace of one lies within
// DescriptionOptions::max_angle_deg of what the other could look like, by all of its fields and in any of its
// variants, re-tuning projected out.
std::vector<ConfusablePair> confusable_pairs(const ExplanationSearch& search,
                                             const DescriptionOptions& options);

// The class of each effect: what it can't be told from by these drives, as the other effect or a cause from
// outside could look like its trace, by the same angle. An effect is of the class of the re-tuned parameters
// where these drives would not surely have shown it at its usual size beside them
// (DescriptionOptions::surely_seen), the parameters taking most of its trace.
std::vector<LookAlike> look_alikes(const ExplanationSearch& search, const DescriptionOptions& options);

}  // namespace slipway::gap
