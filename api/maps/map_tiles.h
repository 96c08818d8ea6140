#pragma once

#include "api/files/terrain_site.h"
#include "api/requests/map_request.h"
#include "core/progress.h"
#include "dem/raster_tiles.h"
#include "planner/maps/cell_map.h"

namespace slipway::api {

inline constexpr int kTilesOfPiece = 2;  // to each side of a piece of ground that is read as one

// Computes the tiles that the store does not have yet, in parallel, from ground that is read piece by piece:
// memory is bounded whatever the map's size. Errors: those of reading the terrain; unwritable_file;
// cancelled.
Result<void> fill_tiles(const planner::CellMap& map, const TerrainSite& site, const Legend& legend,
                        const dem::RasterLayer& layer, dem::TileStore& store, std::size_t threads,
                        Progress& progress);
// The same from a raster in memory, row by row; classes as whole numbers.
Result<void> fill_tiles(const std::vector<float>& values, const dem::RasterLayer& layer,
                        dem::TileStore& store);

// The coarser levels, from the tiles of level 0.
Result<void> fill_coarser_levels(const dem::RasterLayer& layer, dem::TileStore& store, std::size_t threads,
                                 Progress& progress);
// Of the cells of level 0, whatever the threads. Errors: those of the store; cancelled.
Result<MapStatistics> statistics_of(const dem::RasterLayer& layer, const dem::TileStore& store,
                                    std::size_t threads, const Progress& progress);

}  // namespace slipway::api
