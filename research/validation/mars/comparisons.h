#pragma once

#include <filesystem>

#include "core/result.h"
#include "research/validation/report/report.h"

namespace slipway::validation {

// Comparisons with what was driven on Mars, and the papers about those rovers. `data` is the folder that also
// holds rovers, soils and terrains; what the comparisons need beyond those is in its folder validation.
// Errors: unreadable_data, where a file is missing or is not as expected.
Result<Report> zhurong_states(const std::filesystem::path& data);
Result<Report> zhurong_wheels(const std::filesystem::path& data);
Result<Report> zhurong_pull(const std::filesystem::path& data);
Result<Report> curiosity_attitude(const std::filesystem::path& data);
Result<Report> curiosity_hops(const std::filesystem::path& data);
Result<Report> curiosity_steps(const std::filesystem::path& data);
Result<Report> curiosity_outcomes(const std::filesystem::path& data);
Result<Report> fido_table_1(const std::filesystem::path& data);
Result<Report> roams_table_1(const std::filesystem::path& data);
Result<Report> artemis_cases(const std::filesystem::path& data);

}  // namespace slipway::validation
