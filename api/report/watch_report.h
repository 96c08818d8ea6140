#pragma once

#include <string>
#include <vector>

#include "api/chart/chart.h"
#include "api/chart/report_page.h"
#include "gap/diagnosis/drive_watch.h"

namespace slipway::api {

// Whether something has changed, since which drives, and at which drive the alarm was raised: one sentence.
std::string change_words(const gap::DriveWatch& watch);

// What looks changed at the moment of the alarm, and that this is no diagnosis; "" without an alarm.
std::string first_pointer_words(const gap::DriveWatch& watch);

// Which of the answers counts: the diagnosis of the drives since the change, where one was made; "" without
// an alarm.
std::string deciding_words(const gap::DriveWatch& watch);

// Evidence over the drives with the limit and the range of the onset, then the pictures of the diagnosis,
// where there is one.
std::vector<NamedChart> draw_watch(const gap::DriveWatch& watch);

// A watch for people, with those of draw_watch()'s charts that are given. `campaign`: the drives watched,
// those that it learnt from among them.
ReportPage watch_report(const gap::DriveCampaign& campaign, const gap::DriveWatch& watch,
                        const std::vector<NamedChart>& charts);

}  // namespace slipway::api
