#pragma once

#include <string>
#include <string_view>

#include "core/result.h"

namespace slipway::api {

// The time history of the dynamic drive in a "prediction/1" document, as draw_time_history() draws those of
// campaigns, from the samples that the document has: as SVG. Errors: malformed_json; no_data where the answer
// has no dynamic drive or that has no samples; internal where its columns do not fit each other.
Result<std::string> draw_drive_history(std::string_view answer);

}  // namespace slipway::api
