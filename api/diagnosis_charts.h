#pragma once

#include <string>
#include <vector>

#include "api/chart.h"
#include "gap/diagnosis.h"
#include "gap/drive_campaign.h"

namespace slipway::api {

// A diagnosis's pictures; those that have nothing to show are not among them:
//   explanations  the probability of each
//   channels      the gap over its noise, by channel and wheel, before any re-tuning
//   ladder        by channel: nominal, re-tuned, with the effects, floor, with 90 % intervals
//   windows       by channel: what was predicted over what was measured, of drives held out of the fit
//   parameters    what was re-tuned, over its prior's deviation
//   places        the drives on their terrains, and discs where the gap sits
std::vector<NamedChart> draw_diagnosis(const gap::DriveCampaign& campaign, const gap::Diagnosis& diagnosis);

}  // namespace slipway::api
