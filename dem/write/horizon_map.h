#pragma once

#include <filesystem>
#include <string>

#include "core/progress.h"
#include "core/result.h"
#include "dem/grid_geometry.h"
#include "dem/horizon.h"

namespace slipway::dem {

// Cells of `every` by `every` of a terrain's; what is left over at the east and the south is none.
GridGeometry coarser_grid(const GridGeometry& geometry, int every);

// Writes what Horizon tells from each cell's centre as a cloud-optimised GeoTIFF: a band for each of
// `directions`, the first to the north, clockwise, in hundredths of a degree (Int16 with its scale). Memory
// is that of the horizon and of a few rows. `out` must not exist; nothing is left there where this fails.
// Errors: unwritable_file with GDAL's reasons; cancelled.
Result<void> write_horizon_map(const std::filesystem::path& out, const Horizon& horizon,
                               const GridGeometry& cells, const std::string& crs_wkt, double eye_m,
                               int directions, std::size_t threads, Progress& progress);

}  // namespace slipway::dem
