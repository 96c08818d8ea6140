#pragma once

#include "core/progress.h"
#include "core/result.h"
#include "gap/diagnosis/model/drive_campaign.h"
#include "gap/diagnosis/search/reference_learning.h"

namespace slipway::gap {

// Whether a campaign can be asked what has changed since the reference. Errors: invalid_request at /reference
// where it is another rover's or another gravity's, or is the campaign itself.
Result<void> check_reference(const DriveCampaign& reference, const DriveCampaign& campaign);

// The campaign as one that asks what has changed since the reference drives, with what they told. Rover and
// soils of the same names are the reference's nominal ones: they are one rover on one ground; where the
// campaign's numbers differ, or its rows are the reference's, a note says so. Errors: those of
// check_reference; cancelled.
Result<DriveCampaign> since_reference(const DriveCampaign& reference, const DriveCampaign& campaign,
                                      const DiagnosisOptions& options, Progress& progress);
// The same of what was learnt before. Errors: invalid_request.
Result<DriveCampaign> since_reference(const LearntReference& learnt, const DriveCampaign& campaign,
                                      const DiagnosisOptions& options);

}  // namespace slipway::gap
