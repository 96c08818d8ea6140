#pragma once

#include <filesystem>

#include "core/result.h"
#include "validation/report.h"

namespace slipway::validation {

// Each runs one comparison. data: the folder that also holds rovers, soils and terrains; what the comparisons
// need beyond those is in its folder validation. Errors: unreadable_data, where a file is missing or not as
// expected.
Result<Report> kernel_cross_check(const std::filesystem::path& data);
Result<Report> ding_2011(const std::filesystem::path& data);
Result<Report> ding_2011_fitted(const std::filesystem::path& data);
Result<Report> zhurong_states(const std::filesystem::path& data);
Result<Report> zhurong_wheels(const std::filesystem::path& data);
Result<Report> zhurong_pull(const std::filesystem::path& data);
Result<Report> independent_simulator(const std::filesystem::path& data);
Result<Report> curiosity_attitude(const std::filesystem::path& data);
Result<Report> rungs(const std::filesystem::path& data);
Result<Report> dynamic_rung(const std::filesystem::path& data);
Result<Report> virtual_bevameter(const std::filesystem::path& data);
Result<Report> plate_tests(const std::filesystem::path& data);
Result<Report> pavlov_tests(const std::filesystem::path& data);
Result<Report> pavlov_wheel(const std::filesystem::path& data);
Result<Report> cuadriga_data(const std::filesystem::path& data);
Result<Report> cuadriga_drives(const std::filesystem::path& data);
Result<Report> cuadriga_campaign(const std::filesystem::path& data);
Result<Report> fido_table_1(const std::filesystem::path& data);
Result<Report> roams_table_1(const std::filesystem::path& data);
Result<Report> sealed_campaigns(const std::filesystem::path& data);
Result<Report> artemis_cases(const std::filesystem::path& data);

}  // namespace slipway::validation
