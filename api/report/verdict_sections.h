#pragma once

#include "api/chart/report_page.h"
#include "api/json/json_value.h"

namespace slipway::api {

// What every page of a decided drive begins with: the verdict in its colour.
void add_verdict_banner(ReportPage& page, const json::JsonValue& document);

// What would change a verdict that is no GO; nothing for a GO. `decision` has the verdict and the advice.
void add_advice(ReportPage& page, const json::JsonValue& decision);

}  // namespace slipway::api
