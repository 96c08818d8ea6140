#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "api/files/campaign/import_mapping.h"
#include "core/result.h"

namespace slipway::api {

// What was understood of a column, over all drives, in the campaign's unit.
struct ImportedColumn {
  std::string key, to, from, unit;                   // as in ImportColumn
  double factor = 1.0, offset = 0.0, delay_s = 0.0;  // the sign in the factor
  double lowest = 0.0, highest = 0.0;
  std::size_t values = 0, missing = 0;
  bool turned = false, by_rate = false;  // as in ImportColumn
};

struct ImportedDrive {
  std::string id, file;            // in the campaign that is made
  std::size_t index = 0;           // in the mapping's list of drives
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
  std::string mapping_file;                // its name beside the logs
  std::string known_file, known_document;  // what was known before: its name and bytes
  std::vector<WheelNames> wheels;          // that {w} stands for
  std::string clock_unit;                  // of numbers; "" where times are text
  std::vector<ImportedColumn> columns;
  bool from_ned = false;  // recorded x north, y east, z down
  std::vector<ImportedDrive> drives;
  std::vector<std::string> passed_over;                    // columns of the files that nothing asked for
  std::vector<std::pair<std::string, std::string>> files;  // campaign.json and the drives': name, bytes
  std::vector<std::filesystem::path> copied;               // rasters that the known terrains name
  std::vector<std::string> notes;     // how logs were read, where it can be read in another way
  std::vector<std::string> warnings;  // what logs show themselves, before a campaign is made of them
  // Of the mapping, the logs and what was known. Drives and columns at fault are not in the campaign; where
  // `files` has no campaign.json, none could be made.
  std::vector<Fault> faults;
};

// The first column of which a part is this: its key in the mapping (`key`), the campaign's column (`to`);
// nullptr: none.
const ImportedColumn* column_with(const ImportedCampaign& campaign, std::string ImportedColumn::*part,
                                  std::string_view value);

// Reads the files that the mapping names, from its folder, and makes a drive-campaign/1 of them, of as much
// as is without fault; nothing is written. Faults are in the answer, so that those of the campaign's own
// reader can join them (import_faults.h): columns that are not there, cells that are no number, clocks that
// do not go on. Errors: unreadable_data where the mapping can't be read or is no TOML.
Result<ImportedCampaign> import_drives(const std::filesystem::path& mapping);

}  // namespace slipway::api
