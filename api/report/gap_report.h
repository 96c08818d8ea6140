#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "api/chart/chart.h"
#include "api/chart/report_page.h"
#include "gap/diagnosis/diagnosis.h"

namespace slipway::api {

// Sections of a diagnosis' report: what the reference drives taught (none without a reference), how far the
// gap closes, where it is.
void write_reference(ReportPage& page, const gap::Diagnosis& d);
void write_ladder(ReportPage& page, const gap::Diagnosis& d, const std::vector<NamedChart>& charts);
void write_where(ReportPage& page, const gap::Diagnosis& d, const std::vector<NamedChart>& charts);

// The chart of this name, where there is one.
void add_picture(ReportPage& page, const std::vector<NamedChart>& charts, std::string_view name,
                 std::string_view caption);

}  // namespace slipway::api
