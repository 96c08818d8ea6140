#pragma once

#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dem/terrain.h"

namespace slipway::dem {

// A raster whose cells are turned north-up and whose coordinates are metres, as far as that needs no new
// cells.
struct Arrangement {
  std::unique_ptr<OGRSpatialReference> crs;
  std::array<double, 6> grid{};  // GDAL's geotransform
  bool flips_rows = false, flips_columns = false;
  double metres_per_height = 1.0;
  bool reprojects = false;
  std::vector<std::string> changes;
};

// How cells and coordinates come to be in metres, north-up. crs: the horizontal part of the raster's system.
Arrangement arrange(GDALDataset& dataset, const OGRSpatialReference& crs);

// In the arrangement's coordinates, which may be degrees.
Extent extent_of(const Arrangement& a, int rows, int columns);

// The shorter side of a cell, also of one in degrees.
double cell_side_m(const Arrangement& a);

// Why the map is too large for one projection; nothing where it is not.
std::optional<std::string> fault_of_size(const Arrangement& a, const Extent& extent);

}  // namespace slipway::dem
