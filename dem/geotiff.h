#pragma once

#include <cstdint>
#include <string>

#include "core/result.h"
#include "dem/soil_map.h"
#include "dem/terrain.h"

namespace slipway::dem {

// A terrain as the bytes of a GeoTIFF: one band of Float32 heights in metres, missing cells at the declared
// nodata value. crs_wkt may be empty: such a file has a place on its own map and none on a planet, and
// open_elevation refuses it.
Result<std::string> encode_geotiff(const Terrain& terrain, const std::string& crs_wkt);

// A soil map as a raster of its classes, Int16; cells without a soil have the class `elsewhere`.
Result<std::string> encode_geotiff(const SoilMap& map, std::int16_t elsewhere, const std::string& crs_wkt);

}  // namespace slipway::dem
