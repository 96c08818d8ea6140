#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "api/files/campaign/import_mapping.h"
#include "core/result.h"

namespace slipway::api {

// What was understood of a column, over all drives, in the campaign's unit.
struct ImportedColumn {
  std::string to, from, unit;
  double factor = 1.0, offset = 0.0, delay_s = 0.0;  // the sign in the factor
  double lowest = 0.0, highest = 0.0;
  std::size_t values = 0, missing = 0;
};

struct ImportedDrive {
  std::string id, file;            // in the campaign that is made
  std::string log;                 // the file that it was read from
  std::vector<std::size_t> lines;  // of the log, by row
  std::size_t rows = 0;
  double duration_s = 0.0, interval_s = 0.0;  // the median from row to row
  double commanded_m = 0.0, travelled_m = 0.0;
  // For pictures: time and every column's values, NaN where there is none.
  std::vector<double> time_s;
  std::vector<std::vector<double>> values;  // by ImportedCampaign::columns
};

struct ImportedCampaign {
  std::string name;
  std::vector<ImportedColumn> columns;
  bool from_ned = false;  // recorded x north, y east, z down
  std::vector<ImportedDrive> drives;
  std::vector<std::string> passed_over;                    // columns of the files that nothing asked for
  std::vector<std::pair<std::string, std::string>> files;  // campaign.json and the drives': name, bytes
  std::vector<std::filesystem::path> copied;               // rasters that the known terrains name
};

// Reads the files that the mapping names, from its folder, and makes a drive-campaign/1 of them; nothing is
// written. All faults of all files together: columns that are not there, cells that are no number, clocks
// that do not go on. Errors: unreadable_data, and those of read_import_mapping.
Result<ImportedCampaign> import_drives(const std::filesystem::path& mapping);

// Faults that the campaign's reader found in a drive that was made also say where that stands in the log: its
// file, line and column.
void place_in_logs(const ImportedCampaign& campaign, Error& error);

}  // namespace slipway::api
