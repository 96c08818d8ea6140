#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/result.h"
#include "dem/elevation_source.h"
#include "dem/grid_geometry.h"

namespace slipway::dem {

// One row of a legend: the label of a mapped class, and the soil that it is assumed to be. A class without a
// soil is unknown ground.
struct SoilClass {
  int value = 0;                          // the raster's value; for polygons the row's own number
  std::string label;                      // "SMR": for polygons, the value of the legend's property
  std::optional<std::string> soil;        // the name of a soil distribution
  std::optional<double> rock_share = {};  // of its ground that rocks cover, where it is stated
};

// The assumed soil at each place: immutable, shared by pointer. A cell without a class, a class that the
// legend does not have, and a class without a soil are unknown ground. It is returned as an empty optional
// and never replaced by a default.
class SoilMap {
 public:
  // classes and known: rows * columns values from the north-west; known[i] == 0 marks a cell without a class.
  SoilMap(GridGeometry geometry, std::vector<std::int16_t> classes, std::vector<std::uint8_t> known,
          std::vector<SoilClass> legend);

  const GridGeometry& geometry() const { return geometry_; }
  const std::vector<SoilClass>& legend() const { return legend_; }
  // The names of the soils in the legend, without repeats, in the legend's order.
  const std::vector<std::string>& soils() const { return soils_; }

  // The class of the cell that holds the point (the nearest value, never interpolated); empty where there is
  // none.
  std::optional<int> class_at(double x_m, double y_m) const;
  // Index into soils(); empty on unknown ground.
  std::optional<std::size_t> soil_at(double x_m, double y_m) const;
  // How many cells have the class of each row of the legend, in its order.
  std::vector<std::size_t> cells_of_rows() const;
  // The share of the map's cells that are unknown ground, in [0, 1].
  double unknown_fraction() const;

 private:
  std::optional<std::size_t> index_at(double x_m, double y_m) const;

  std::int16_t soil_of(std::size_t cell) const {
    return known_[cell] == 0 ? std::int16_t{-1} : soil_of_class_[static_cast<std::uint16_t>(classes_[cell])];
  }

  GridGeometry geometry_;
  std::vector<std::int16_t> soil_of_class_;  // index into soils(); -1 for unknown ground
  std::vector<std::int16_t> classes_;
  std::vector<std::uint8_t> known_;
  std::vector<SoilClass> legend_;
  std::vector<std::string> soils_;
};

// Reads a class raster (integer, one band) on the cells that meet the extent. Its geometry may differ from
// the elevation's, but its CRS must be the same (errors as open_elevation); where the elevation lies in a
// local frame, it must have none. Cells at nodata have no class. With a `step` above 1 it has about one cell
// for so many of the elevation's along each side, with the class that is at one place in it.
Result<std::shared_ptr<const SoilMap>> read_soil_raster(const std::filesystem::path& path,
                                                        const ElevationInfo& ground, const Extent& extent,
                                                        std::vector<SoilClass> legend, int step = 1);

enum class PolygonCoordinates {
  kLongitudeLatitude,  // degrees, east-positive planetocentric, on the elevation's own datum (RFC 7946 on
                       // that body)
  kMap,                // metres in the elevation's CRS
};

// Whether a file holds polygons of units, by its ending in any case: .geojson, .json, .shp or .gpkg.
bool is_unit_file(const std::filesystem::path& path);

// Burns polygons of such a file onto a grid of the elevation's cells over the extent, or one of whole
// numbers of them, at least `step`, that has at most kMaxWindowCells; a cell takes the class of the last
// polygon that holds its centre. property names the label that the legend is matched by. A label that the
// legend does not have is unknown ground. Faults name the feature: "/features/12/geometry".
Result<std::shared_ptr<const SoilMap>> read_soil_polygons(const std::filesystem::path& path,
                                                          const ElevationInfo& ground, const Extent& extent,
                                                          const std::string& property,
                                                          PolygonCoordinates coordinates,
                                                          std::vector<SoilClass> legend, int step = 1);

}  // namespace slipway::dem
