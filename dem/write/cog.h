#pragma once

#include <filesystem>
#include <string>

#include "core/progress.h"
#include "core/result.h"
#include "dem/raster_tiles.h"

namespace slipway::dem {

// Writes a raster as a cloud-optimised GeoTIFF [OGC 21-026]: tiles of kTileSide cells, DEFLATE, with the
// overviews that the store has, metadata and (of classes) a colour table. The same tiles give the same bytes
// for any number of threads, which compress. `out` must not exist; its folder is the only one that is written
// to, and nothing is left there where this fails. Errors: unwritable_file with GDAL's reasons; cancelled.
Result<void> write_cog(const std::filesystem::path& out, const RasterLayer& layer, const TileStore& tiles,
                       std::size_t threads, Progress& progress);
// The same in memory: the file's bytes.
Result<std::string> encode_cog(const RasterLayer& layer, const TileStore& tiles, std::size_t threads,
                               Progress& progress);

}  // namespace slipway::dem
