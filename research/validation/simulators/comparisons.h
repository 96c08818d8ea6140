#pragma once

#include <filesystem>

#include "core/result.h"
#include "research/validation/report/report.h"

namespace slipway::validation {

// Comparisons with other simulators, and the levels of fidelity with each other. `data` is the folder that
// also holds rovers, soils and terrains; what the comparisons need beyond those is in its folder validation.
// Errors: unreadable_data, where a file is missing or is not as expected.
Result<Report> kernel_cross_check(const std::filesystem::path& data);
Result<Report> independent_simulator(const std::filesystem::path& data);
Result<Report> table_level(const std::filesystem::path& data);
Result<Report> dynamic_level(const std::filesystem::path& data);
Result<Report> sealed_campaigns(const std::filesystem::path& data);
Result<Report> sealed_levels(const std::filesystem::path& data);
Result<Report> sealed_marginals(const std::filesystem::path& data);
Result<Report> sealed_detectability(const std::filesystem::path& data);

}  // namespace slipway::validation
