#pragma once

#include <filesystem>
#include <span>

#include "campaign/drive_table.h"
#include "campaign/tune.h"
#include "core/result.h"

namespace slipway::api {

// Where drives of a table ended, as measured:
//   a folder   of a "drive-campaign/1": the last row of each drive's CSV, of its last leg where it has
//   several a file     CSV with the columns drive, x_m, y_m, yaw_deg and a row a drive, as a survey writes it
// Drives that are not there, or whose last row has no pose, are left out. Errors: unreadable_data with its
// place; those of json::read_measured_campaign.
Result<campaign::MeasuredFinals> read_measured_finals(const std::filesystem::path& path,
                                                      const campaign::DriveTable& table,
                                                      std::span<const campaign::TableDrive> drives);

}  // namespace slipway::api
