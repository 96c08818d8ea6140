#pragma once

#include <string>

#include "api/files/terrain_import.h"

namespace slipway::server {

struct TerrainImportOptions {
  api::TerrainImport order;  // its data folder is found when the command runs
  std::string data;          // of --data; empty: found as by every command
  std::string soil, legend;  // files; empty: none
  bool map_coordinates = false;
  bool json = false;
};

// Makes a terrain of a map. The exit status: 0 done, 2 the map or the command can't be used, with every
// reason and its remedy, 1 nothing could be written or it was given up. Progress goes to standard error.
int import_terrain(const TerrainImportOptions& options);

}  // namespace slipway::server
