#pragma once

#include <string>

#include "api/requests/map_request.h"
#include "dem/raster_tiles.h"
#include "planner/problem/problem.h"

namespace slipway::api {

// Hashes of what a map is made of.
struct MapSources {
  std::string elevation_sha256, soil_sha256;  // of the terrain's files; empty: none
};

// A map's raster without its cells: classes with their colours, unit, and metadata that says what was asked
// and of what it was made.
dem::RasterLayer map_layer(const MapRequest& request, const Provenance& provenance,
                           const planner::PlanProblem& problem, const MapSources& sources,
                           const dem::GridGeometry& geometry, const std::string& crs_wkt);

// The figures into the band's metadata, as GDAL and QGIS know them.
void add_statistics(const MapStatistics& statistics, dem::RasterLayer& layer);

// A style for QGIS: a file of this name with .qml in the place of .tif is taken by itself.
std::string map_style(const dem::RasterLayer& layer, const MapStatistics& statistics);
// The names of the classes for GDAL's tools, "MAP.tif.aux.xml"; empty for maps without classes.
std::string map_categories(const dem::RasterLayer& layer);

}  // namespace slipway::api
