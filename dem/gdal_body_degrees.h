#pragma once

#include <ogr_spatialref.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dem/grid_geometry.h"

class GDALDataset;

// Longitudes go round: 354.47 deg and -5.53 deg are one place. On a cylindrical map x goes on evenly where
// they do, so that published maps have x of 226.5 deg as well as of -133.5 deg.
namespace slipway::dem {

// How many metres x grows by in 360 deg of longitude; nothing where it does not grow evenly, and everywhere
// alike.
std::optional<double> turn_of(const OGRSpatialReference& map);

// The same projection about a meridian in the middle of the extent, with x and y as they are: PROJ writes no
// x that is more than half a turn from the meridian. Nothing where none of the extent is, or there is no
// turn.
std::unique_ptr<OGRSpatialReference> on_own_sheet(const OGRSpatialReference& map, const Extent& extent);

// What gdalwarp is to be told of the system of a raster, so that it finds all of it: "-s_srs" and
// on_own_sheet(); no words where the raster's own system does.
std::vector<std::string> warp_source(GDALDataset& raster);

}  // namespace slipway::dem
