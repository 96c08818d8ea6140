#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "campaign/drive_record.h"
#include "campaign/drive_table.h"

namespace slipway::campaign {

// How values spread. Quantiles are linear between order statistics (Hyndman and Fan's type 7).
struct Band {
  int count = 0;
  double lowest = 0.0, p05 = 0.0, p50 = 0.0, p95 = 0.0, highest = 0.0;
};

// Nothing where there is no value.
std::optional<Band> band_of(std::vector<double> values);

// The drives of one terrain: of a tilt table, of one tilt.
struct TerrainSummary {
  std::string terrain;
  int drives = 0;                   // that are done
  std::map<std::string, int> ends;  // how many ended how
  // Of drives that go somewhere.
  std::optional<Band> slip_ratio;
  std::optional<Band> heading_error_rad;  // without its sign
  std::optional<Band> position_error_m;
  // Of drives that only turn in place.
  std::optional<Band> turn_error_rad;  // without its sign
  // Among repeats of the same drive, one value a drive: root mean square of the distances to their mean
  // place, and of the headings' differences to their mean.
  std::optional<Band> repeat_spread_m;
  std::optional<Band> repeat_spread_rad;
};

// In the order of the table's terrains; those without a drive that is done are left out. Drives without a
// record are not done yet.
std::vector<TerrainSummary> summarise(const DriveTable& table, std::span<const TableDrive> drives,
                                      const std::map<std::string, DriveRecord>& records);

}  // namespace slipway::campaign
