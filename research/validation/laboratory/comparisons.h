#pragma once

#include <filesystem>

#include "core/result.h"
#include "research/validation/report/report.h"

namespace slipway::validation {

// Comparisons with tests of wheels and plates in laboratories. `data` is the folder that also holds rovers,
// soils and terrains; what the comparisons need beyond those is in its folder validation. Errors:
// unreadable_data, where a file is missing or is not as expected.
Result<Report> ding_2011(const std::filesystem::path& data);
Result<Report> ding_2011_fitted(const std::filesystem::path& data);
Result<Report> ding_2011_closures(const std::filesystem::path& data);
Result<Report> virtual_bevameter(const std::filesystem::path& data);
Result<Report> plate_tests(const std::filesystem::path& data);
Result<Report> pavlov_tests(const std::filesystem::path& data);
Result<Report> pavlov_wheel(const std::filesystem::path& data);
Result<Report> grousered_wheel(const std::filesystem::path& data);

}  // namespace slipway::validation
