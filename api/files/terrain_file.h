#pragma once

#include <string_view>

#include "api/files/terrain_description.h"
#include "core/result.h"

namespace slipway::api::json {

// Reads terrain.json ("terrain/1"); all its faults together. Whether its files exist is for who opens it.
Result<TerrainDescription> read_terrain_file(std::string_view bytes);

}  // namespace slipway::api::json
