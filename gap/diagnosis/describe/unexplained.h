#pragma once

#include <vector>

#include "gap/diagnosis/result/result.h"
#include "gap/diagnosis/search/prepared_campaign.h"

namespace slipway::gap {

// What remains beside a fit, by where it enters and what it depends on, the largest shares first.
std::vector<ResidualShape> describe_unexplained(const PreparedCampaign& prepared,
                                                const FittedExplanation& fit);

}  // namespace slipway::gap
