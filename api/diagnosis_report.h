#pragma once

#include <string>
#include <vector>

#include "api/chart.h"
#include "gap/diagnosis.h"
#include "gap/drive_campaign.h"

namespace slipway::api {

// A diagnosis for people, as Markdown that shows the charts ("ladder.svg") where they are given.
std::string diagnosis_report(const gap::DriveCampaign& campaign, const gap::Diagnosis& diagnosis,
                             const std::vector<NamedChart>& charts);

}  // namespace slipway::api
