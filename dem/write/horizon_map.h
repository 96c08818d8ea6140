#pragma once

#include <filesystem>
#include <string>

#include "core/progress.h"
#include "core/result.h"
#include "dem/grid_geometry.h"
#include "dem/horizon/horizon_sweep.h"

namespace slipway::dem {

// Cells of `every` by `every` of a terrain's; what is left over at the east and the south is none.
GridGeometry coarser_grid(const GridGeometry& geometry, int every);

// Writes the horizon that the eyes see as a cloud-optimised GeoTIFF: a band for each of `directions`, the
// first to the map's north, clockwise, in hundredths of a degree (Int16 with its scale). `eye_m` is what it
// says of their height over the ground. `out` must not exist; nothing is left there where this fails. Errors:
// unwritable_file with GDAL's reasons; cancelled.
Result<void> write_horizon_map(const std::filesystem::path& out, const HorizonSweep& ground, const Eyes& eyes,
                               const std::string& crs_wkt, double eye_m, int directions, std::size_t threads,
                               Progress& progress);

}  // namespace slipway::dem
