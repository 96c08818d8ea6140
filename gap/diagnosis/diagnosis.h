#pragma once

#include "core/progress.h"
#include "core/result.h"
#include "gap/diagnosis/model/drive_campaign.h"
#include "gap/diagnosis/result/result.h"
#include "gap/diagnosis/search/diagnosis_options.h"

namespace slipway::gap {

// The diagnosis of the gap between prediction and recorded drives. Deterministic. Errors: cancelled;
// invalid_request for a withheld effect that is not in the catalogue.
Result<Diagnosis> diagnose(const DriveCampaign& campaign, const DiagnosisOptions& options,
                           Progress& progress);

// What has changed since the reference drives. Errors: of this and of since_reference.
Result<Diagnosis> diagnose_since(const DriveCampaign& reference, const DriveCampaign& campaign,
                                 const DiagnosisOptions& options, Progress& progress);

}  // namespace slipway::gap
