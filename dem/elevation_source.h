#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "core/result.h"
#include "dem/grid_geometry.h"
#include "dem/terrain.h"

namespace slipway::dem {

// The properties of an elevation raster that are known without reading its cells.
struct ElevationInfo {
  GridGeometry geometry;
  std::string crs_name;  // "Mars2000 Equidistant Cylindrical clon0"
  std::string crs_wkt;   // "" in a local frame
  std::string body;      // "Mars", "Moon", "Earth" or "other", from the ellipsoid's semi-major axis
  double semi_major_axis_m = 0.0;
  std::string data_type;  // "Float32", "Int16", ...
  bool scaled = false;    // heights are scale * stored + offset
};

// An elevation raster on disk, which opens fast and is read by windows. It is thread-safe. Reads of
// cells are serialised, since GDAL datasets are not thread-safe; of samples several threads read at once
// where the file is tiled as the import makes it.
class ElevationSource {
 public:
  virtual ~ElevationSource() = default;
  virtual const ElevationInfo& info() const = 0;
  // The cells that meet the extent, plus two cells around them where the raster has them, so that heights and
  // normals inside the extent are those of the whole raster. Of more than kMaxWindowCells they are read by
  // tiles when they are looked at (see Terrain). Errors: off_map where they don't meet, unreadable_raster
  // where the file is damaged (names the window).
  virtual Result<std::shared_ptr<const Terrain>> read(const Extent& extent) const = 0;
  // For pictures of wide ground: of every step-th row and column one sample, as a terrain with cells so many
  // times as large, with two of them around the extent. Lengths need not be true. step >= 1. Errors as read.
  virtual Result<std::shared_ptr<const Terrain>> read_samples(const Extent& extent, int step) const = 0;
};

// How to treat a raster that names no coordinate reference system, or a local (engineering) system in metres.
enum class PlacelessRaster {
  kRefused,     // it is refused, since its units and its place are unknown
  kLocalFrame,  // its x and y are metres east and north in a frame of its own, as the caller knows from
                // elsewhere
};

constexpr long long kMaxWindowCells = 36'000'000;  // that are read at once: 6,000 x 6,000, 180 MB in memory

// Opens a raster of an allowed driver as elevation: one band, float or scaled integer, square to the map
// axes, in a metric projected system. Refused with the reason, and the command that would convert it: degree
// pixels, a west-positive axis, feet, a rotated or south-up grid, no CRS. Nothing but this path is read: no
// network, no sidecar outside it, no other driver.
Result<std::shared_ptr<const ElevationSource>> open_elevation(
    const std::filesystem::path& path, PlacelessRaster placeless = PlacelessRaster::kRefused);

}  // namespace slipway::dem
