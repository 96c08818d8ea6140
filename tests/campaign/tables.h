#pragma once

#include <filesystem>
#include <string>

#include "api/files/catalogue.h"
#include "api/files/drive_table/drive_table_file.h"
#include "campaign/drive_table.h"

namespace slipway::campaign {

inline const api::Catalogue& shipped_catalogue() {
  static const api::Catalogue catalogue = *api::load_catalogue(SLIPWAY_DATA_FOLDER);
  return catalogue;
}

inline Result<DriveTable> read_table(const std::string& bytes) {
  return api::json::read_campaign_table(bytes, SLIPWAY_DATA_FOLDER, shipped_catalogue());
}

// Two tilts, two headings, two repeats of a short drive, and a turn in place: ten drives of a few seconds.
inline const std::string kSmallTable = R"({
  "format": "campaign-table/1", "name": "small", "summary": "a small table", "sources": [],
  "rover": "fido-class", "gravity_m_s2": 9.81, "seed": 7,
  "terrains": [{"name": "level", "soil": "dry_sand", "size_m": 6},
               {"name": "slope", "soil": "dry_sand", "tilt_deg": 5, "size_m": 6}],
  "sensors": {"position_m": {"noise": 0.002}, "sinkage_m": {"noise": 0.001, "interval_s": 2}},
  "drives": [
    {"id": "ahead", "headings_deg": [0, 90], "legs": [{"length_m": 0.3}], "repeats": 2, "plot": true},
    {"id": "turn", "terrains": ["level"], "legs": [{"turn_deg": -10}], "final_only": true},
    {"id": "both", "terrains": ["level"], "deformed_terrain": true,
     "legs": [{"length_m": 0.2, "backwards": true, "curvature_1_m": 0.5}, {"turn_deg": 10}]}]})";

// Where a test may write; empty when it begins.
inline std::filesystem::path empty_folder(const std::string& name) {
  const std::filesystem::path folder = std::filesystem::path(SLIPWAY_TEST_OUTPUT) / name;
  std::filesystem::remove_all(folder);
  return folder;
}

}  // namespace slipway::campaign
