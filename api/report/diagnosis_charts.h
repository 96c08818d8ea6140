#pragma once

#include <string>
#include <vector>

#include "api/chart/chart.h"
#include "gap/diagnosis/diagnosis.h"
#include "gap/diagnosis/model/drive_campaign.h"

namespace slipway::api {

// A diagnosis's pictures; those that have nothing to show are not among them:
//   explanations  the probability of each
//   channels      the gap over its noise, by channel and wheel, before any re-tuning
//   ladder        by channel: nominal, re-tuned, with the effects, floor, with 90 % intervals
//   windows       by channel: what was predicted over what was measured, of drives held out of the fit
//   parameters    what was re-tuned, over its prior's deviation
//   regimes       slices of the drives that hold more of the gap than of the data
//   map           windows of held-out drives on their terrains, coloured by how far they are off, and places
std::vector<NamedChart> draw_diagnosis(const gap::DriveCampaign& campaign, const gap::Diagnosis& diagnosis);

}  // namespace slipway::api
