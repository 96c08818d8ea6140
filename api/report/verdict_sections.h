#pragma once

#include <string>
#include <vector>

#include "api/chart/report_page.h"
#include "api/json/json_value.h"
#include "core/result.h"

namespace slipway::api {

// What every page of a decided drive begins with: the verdict in its colour.
void add_verdict_banner(ReportPage& page, const json::JsonValue& document);

// What would change a verdict that is no GO, in words; nothing for a GO.
std::vector<std::string> what_would_change(const json::JsonValue& decision);

// The same as a section. `decision` has the verdict and the advice.
void add_advice(ReportPage& page, const json::JsonValue& decision);

// A map of an answer, or why there is none: an old answer's page is still whole without it.
void add_map(ReportPage& page, Result<std::string> map, std::string_view caption);

// The request and what the answer was computed with.
void add_provenance(ReportPage& page, const json::JsonValue& document);

}  // namespace slipway::api
