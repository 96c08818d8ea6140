#pragma once

#include <string>
#include <vector>

#include "api/files/terrain_site.h"
#include "core/result.h"

namespace slipway::api {

// SHA-256 over the names and hashes of a terrain's files: what it is drawn from.
std::string hash_of(const std::vector<TerrainFile>& files);

// All that is known of one terrain: its entry of the list under "terrain", its files with their hashes, where
// it comes from and its licence as texts, the layers that are drawn with their legends, and the tiles' grid.
// files: TerrainSite::files(). Errors: those of reading the texts.
Result<std::string> write_terrain_document(const TerrainSite& site, const std::vector<TerrainFile>& files);

}  // namespace slipway::api
