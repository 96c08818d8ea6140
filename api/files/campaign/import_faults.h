#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "api/files/campaign/drive_import.h"
#include "core/result.h"

namespace slipway::api {

// All faults of an import in one list: those of mapping, logs and what was known, then those that the
// campaign's own reader found in what was made of them, each where it comes from: in a log (file, line and
// column), in the mapping, or in the file of what was known. What the reader can't have found but for a fault
// that is listed already, as a drive that could not be made, is left out.
std::vector<Fault> faults_of_import(const ImportedCampaign& campaign, std::span<const Fault> of_campaign);

// The row of a log that a fault concerns: "log.csv, line 7 (mA_FL)".
std::string place_in_log(const ImportedDrive& drive, std::size_t row, std::string_view column);

}  // namespace slipway::api
