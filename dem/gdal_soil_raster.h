#pragma once

#include <string>

#include "core/result.h"
#include "dem/elevation_source.h"
#include "dem/gdal_raster.h"

namespace slipway::dem {

// Whether a band holds classes: whole numbers of at most 32 bits.
bool holds_classes(GDALRasterBand& band);

// Checks that a raster holds whole numbers and lies in the elevation's system. Errors: unreadable_raster,
// unsupported_crs, with the command that converts `file`.
Result<void> check_class_raster(const CheckedRaster& raster, const ElevationInfo& ground,
                                const std::string& file);

}  // namespace slipway::dem
