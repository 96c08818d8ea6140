#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"

namespace slipway::api {

// How a team's own records become a drive-campaign/1: the file "drive-import/1"
// (docs/reference/drive_import.md).

// Where a column of the campaign comes from: value = sign * factor of the unit * recorded + offset.
struct ImportColumn {
  std::string key;   // in the mapping's [columns]: "x_m", "{w}_current_a"
  std::string to;    // "x_m", "lf_current_a"
  std::string from;  // the column's name in the team's files
  std::string unit;  // as recorded; the campaign's own where the mapping has none
  double factor = 1.0, offset = 0.0, sign = 1.0;
  double delay_s = 0.0;   // it shows what was so long ago: read so much later
  bool turned = false;    // `turned` names its wheel: the sign is the other for it
  bool by_rate = false;   // its sign is that of the wheel's rate, which is taken out of it
  bool at_fault = false;  // the mapping says something of it that can't be
};

// Where the time comes from: unit of the first column's number and, where there is a second, of that one's
// (seconds and nanoseconds). Times as text say themselves how they are written, see import_clock.h; two
// columns of it are read as one text (a date and a time of the day).
struct ImportClock {
  std::string column = {}, unit = "s";
  std::string plus_column = {}, plus_unit = "ns";  // added to it; none where the column has no name
  std::optional<double> ticks_per_s = {};          // of a spacecraft's clock
  std::optional<double> day_s = {};                // how long 24 hours of a clock on the wall take
  bool from_first_row = true;                      // otherwise as recorded
  bool at_fault = false;
};

// An attitude recorded as a unit quaternion, in the place of roll, pitch and yaw.
struct ImportAttitude {
  std::array<std::string, 4> from = {};  // the columns of x, y, z and w, whatever their order in the mapping
  double delay_s = 0.0;
  bool inverse = false;  // it turns the map's axes into the body's, otherwise the body's into the map's
  bool at_fault = false;
};

// The name of a wheel in the campaign, and what stands for {w} in the team's files.
struct WheelNames {
  std::string own, theirs;
};

// A unit that a column may be recorded in: value = factor * (recorded + zero) in the campaign's own.
struct RecordedUnit {
  std::string_view own, name;  // the suffix of the campaign's column, and the unit as mappings call it
  double factor = 1.0, zero = 0.0;
};
// Those of a campaign's column, its own the first; none where its name ends with no unit that is known.
std::vector<RecordedUnit> units_of(std::string_view column);

// Of a clock, in seconds: "s", "ms", "us", "ns", "min", "h", "d". 0 of another.
double clock_unit_s(std::string_view unit);

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
  ImportClock clock;
  std::optional<char> separator;  // nothing: it is found in each file
  std::vector<WheelNames> wheels;
  std::vector<ImportColumn> columns;
  std::optional<ImportAttitude> attitude;
  std::vector<ImportDrive> drives;
  bool separator_at_fault = false;
  std::vector<Fault> faults;  // at "yard.toml#/columns/x_m/unit"
};

// Reads a mapping. `{w}` in a column's two names stands for every wheel of [wheels], by the campaign's name
// and the team's. Faults are in the answer, so that those of the files that it names can join them. Errors:
// unreadable_data (no TOML).
Result<ImportMapping> read_import_mapping(std::string_view bytes, const std::string& file);

}  // namespace slipway::api
