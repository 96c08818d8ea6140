#pragma once

#include <vector>

#include "api/chart/chart.h"
#include "api/chart/report_page.h"
#include "gap/diagnosis/diagnosis.h"
#include "gap/diagnosis/model/drive_campaign.h"

namespace slipway::api {

// A diagnosis for people, with those of draw_diagnosis()'s charts that are given.
ReportPage diagnosis_report(const gap::DriveCampaign& campaign, const gap::Diagnosis& diagnosis,
                            const std::vector<NamedChart>& charts);

// The same behind what the page has already: its sections, and before them what was driven and the verdict.
void write_diagnosis(ReportPage& page, const gap::DriveCampaign& campaign, const gap::Diagnosis& diagnosis,
                     const std::vector<NamedChart>& charts);

}  // namespace slipway::api
