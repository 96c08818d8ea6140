#pragma once

#include <filesystem>

#include "core/result.h"
#include "research/validation/report/report.h"

namespace slipway::validation {

// Comparisons with the logs of the rover Cuadriga. `data` is the folder that also holds rovers, soils and
// terrains; what the comparisons need beyond those is in its folder validation. Errors: unreadable_data,
// where a file is missing or is not as expected.
Result<Report> cuadriga_data(const std::filesystem::path& data);
Result<Report> cuadriga_drives(const std::filesystem::path& data);
Result<Report> cuadriga_campaign(const std::filesystem::path& data);
Result<Report> cuadriga_days(const std::filesystem::path& data);
Result<Report> cuadriga_intervals(const std::filesystem::path& data);

}  // namespace slipway::validation
