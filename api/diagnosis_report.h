#pragma once

#include <vector>

#include "api/chart.h"
#include "api/report_page.h"
#include "gap/diagnosis.h"
#include "gap/drive_campaign.h"

namespace slipway::api {

// A diagnosis for people, with those of draw_diagnosis()'s charts that are given.
ReportPage diagnosis_report(const gap::DriveCampaign& campaign, const gap::Diagnosis& diagnosis,
                            const std::vector<NamedChart>& charts);

}  // namespace slipway::api
