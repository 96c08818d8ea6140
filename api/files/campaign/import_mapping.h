#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"

namespace slipway::api {

// How a team's own records become a drive-campaign/1: the file "drive-import/1" (docs/guide/campaigns.md).

// Where a column of the campaign comes from: value = sign * factor of the unit * recorded + offset.
struct ImportColumn {
  std::string key;   // in the mapping's [columns]: "x_m", "{w}_current_a"
  std::string to;    // "x_m", "lf_current_a"
  std::string from;  // the column's name in the team's files
  std::string unit;  // as recorded; the campaign's own where the mapping has none
  double factor = 1.0, offset = 0.0, sign = 1.0;
  double delay_s = 0.0;   // it shows what was so long ago: read so much later
  bool at_fault = false;  // the mapping says something of it that can't be
};

enum class ImportAxes {
  kEnu,  // x east, y north, z up; yaw counterclockwise from east; positive pitch is nose down
  kNed,  // x north, y east, z down; yaw clockwise from north; positive pitch is nose up
};

struct ImportDrive {
  std::string id, file, terrain, repeat_of;
  double speed_m_s = 0.0, curvature_1_m = 0.0;
  bool turn_in_place = false;
  double turn_rate_deg_s = 0.0;
  std::optional<double> from_s,
      to_s;               // rows of the file that are the drive, by its clock after unit and zero
  std::size_t index = 0;  // in the mapping's list
  bool at_fault = false;
};

// Where something was at fault, so much as could be read.
struct ImportMapping {
  std::string file;  // its own name, in faults
  std::string name;
  std::string known;  // file of what was known before: rover, soils, terrains, ...
  ImportAxes axes = ImportAxes::kEnu;
  std::array<double, 3> origin_m{0.0, 0.0, 0.0};  // in the recorded axes, subtracted
  std::string clock_column, clock_unit = "s";
  bool clock_from_first_row = true;  // otherwise as recorded
  char separator = ',';
  std::vector<ImportColumn> columns;
  std::vector<ImportDrive> drives;
  bool separator_at_fault = false, clock_at_fault = false;
  std::vector<Fault> faults;  // at "yard.toml#/columns/x_m/unit"
};

// Reads a mapping. `{w}` in a column's two names stands for every wheel of [wheels], by the campaign's name
// and the team's. Faults are in the answer, so that those of the files that it names can join them. Errors:
// unreadable_data (no TOML).
Result<ImportMapping> read_import_mapping(std::string_view bytes, const std::string& file);

}  // namespace slipway::api
