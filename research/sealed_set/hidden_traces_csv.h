#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "research/benchmark/location_score.h"

namespace slipway::api {

// Where hidden effects act: a row for each stretch of each drive, by campaign. Columns in any order, all of
// them there: campaign, drive, the window's variables ("slope_deg", ..., "time_s"), and of each channel
// NAME_mean_square, at least 0 or empty. A table without rows is one in which nothing is hidden. All faults
// together, each with its file, line and column. Errors: unreadable_data.
Result<std::map<std::string, std::vector<gap::HiddenTrace>>> read_hidden_traces_csv(std::string_view file,
                                                                                    std::string_view text);

}  // namespace slipway::api
