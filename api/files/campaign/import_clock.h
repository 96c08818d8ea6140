#pragma once

#include <optional>
#include <string>
#include <vector>

#include "api/files/campaign/import_mapping.h"
#include "api/files/campaign/recorded_table.h"
#include "core/result.h"

namespace slipway::api {

// The times of a log's rows in seconds, as the mapping asks for them. Nothing where some are at fault, which
// is added, one fault for each kind. Notes say how times were read that are no numbers,
// which as_text then says.
std::optional<std::vector<double>> read_times(const ImportClock& clock, const std::string& file,
                                              const RecordedTable& table, std::vector<std::string>& notes,
                                              bool& as_text, std::vector<Fault>& faults);

// A warning where decimals of a clock are ticks: they never reach what its seconds are divided into, as
// decimals would.
std::optional<std::string> ticks_as_decimals(const ImportClock& clock, const RecordedTable& table);

}  // namespace slipway::api
