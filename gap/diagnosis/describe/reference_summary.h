#pragma once

#include "gap/diagnosis/result/result.h"
#include "gap/diagnosis/search/prepared_campaign.h"

namespace slipway::gap {

// Of a campaign with a reference, prepared.
ReferenceSummary reference_summary(const PreparedCampaign& prepared, const DriveCampaign& campaign);

}  // namespace slipway::gap
