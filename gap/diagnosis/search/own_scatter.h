#pragma once

#include "core/progress.h"
#include "gap/diagnosis/model/drive_campaign.h"
#include "gap/diagnosis/model/noise_model.h"
#include "gap/diagnosis/model/window_model.h"
#include "gap/diagnosis/search/discrepancy_term.h"
#include "gap/diagnosis/search/explanation_search.h"

namespace slipway::gap {

// What an explanation leaves out is in part taken for the drives' own scatter, under which the missing effect
// then looks small. Explanations are compared fairly only where each has the scatter that is most probable
// beside it [type-II maximum likelihood]: this gives it to the foremost candidates of a search, and to
// nothing, and raises their evidence to what it is with it (over that of `noise`, the scales' prior counted
// in). Each also has the scales of the best, which it may not have found. A soft patch is moved and resized
// under it too. Where reference drives told of the scatter, it holds for all, and nothing is done.
void compare_with_own_scatter(const DriveCampaign& campaign, const WindowModel& model,
                              const NoiseModel& noise, const DiscrepancyTerm& discrepancy,
                              const DiagnosisOptions& options, Progress& progress, ExplanationSearch& search);

}  // namespace slipway::gap
