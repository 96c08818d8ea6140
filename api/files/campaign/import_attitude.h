#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "api/files/campaign/drive_import.h"
#include "api/files/campaign/import_mapping.h"
#include "api/files/campaign/recorded_table.h"
#include "core/result.h"

namespace slipway::api {

// The key and the columns of a quaternion in ImportedCampaign.
inline constexpr std::string_view kAttitudeKey = "attitude";
inline constexpr std::array<std::string_view, 3> kAttitudeColumns{"roll_deg", "pitch_deg", "yaw_deg"};

// Roll, pitch and yaw of the table's rows in degrees; NaN where a part of the quaternion is missing. Rows
// that are no unit quaternion are a fault. The table has its columns.
std::array<std::vector<double>, 3> angles_of_quaternions(const ImportAttitude& attitude,
                                                         const std::string& file, const RecordedTable& table,
                                                         std::vector<Fault>& faults);

// A warning where columns that are mapped as angles are parts of a unit quaternion.
std::optional<std::string> quaternion_as_angles(const ImportMapping& mapping, const RecordedTable& table);

// The value `delay_s` later, between rows by a line, of angles the short way round; `turn` is a full turn in
// the values' unit, 0 of what is no angle. Nothing beyond the ends or beside a missing value.
double delayed(const std::vector<double>& time_s, const std::vector<double>& values, std::size_t row,
               double delay_s, double turn);

// A position, and an attitude, is measured as a whole or not at all: where a delay leaves a part of one
// without a value at an end of the log, so are its other parts. `log_s` are the log's times, the drive's
// being a part of them.
void blank_ends_of_delays(const std::vector<ImportedColumn>& columns, const std::vector<double>& log_s,
                          ImportedDrive& made);

}  // namespace slipway::api
