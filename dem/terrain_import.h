#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/progress.h"
#include "core/result.h"
#include "dem/elevation_source.h"
#include "dem/soil_map.h"

namespace slipway::dem {

// A map that is to become the elevation of a terrain.
struct ElevationImport {
  std::filesystem::path source = {};
  std::string crs = {};   // stands for the system that the file names; empty: the file's own
  bool fix = false;       // mends what can be mended
  int band = 0;           // which of several bands; 0: the only one, or the one that is described as heights
  std::string unit = {};  // of heights, stands for that of the file: "m", "ft", "US survey foot"
  std::optional<double> nodata = {};  // also marks a missing height, as it is stored
};

// What was written.
struct ImportedElevation {
  ElevationInfo info;
  std::string source_format;         // "GTiff"
  std::string source_crs;            // its name
  std::vector<std::string> changes;  // each a sentence; none where the heights are those of the source
  std::string reading;               // "heights: band 1, metres, nodata -9999, ..."
  std::vector<std::string> on_trust, warnings;  // what nobody stated, and what is likely wrong
  double lowest_m = 0.0, highest_m = 0.0;
  double unknown_share = 0.0;  // of the cells, in [0, 1]
};

// Reads the whole map and writes it as a tiled, compressed GeoTIFF of Float32 metres with overviews, which
// open_elevation() takes: without `fix` cell by cell what the source holds. With it, a grid that is south-up
// or in another unit of length keeps its cells too; degrees, a rotated grid and lengths that are not the
// ground's are reprojected to a conformal system around the middle of the map. `out` must not exist; its
// folder is the only one that is written to. Errors: those of the source, one fault each with the command
// that mends it ("--fix mends it" where it does), unwritable_file.
Result<ImportedElevation> import_elevation(const ElevationImport& order, const std::filesystem::path& out,
                                           Progress& progress);

// A map of classes, or polygons of units, that is to become the soil map of a terrain.
struct SoilImport {
  std::filesystem::path source;
  bool polygons = false;      // see is_unit_file()
  std::string property = {};  // of the polygons: which property is the label
  PolygonCoordinates coordinates = PolygonCoordinates::kLongitudeLatitude;
  std::vector<SoilClass> legend = {};
  bool fix = false;
};

struct ImportedSoil {
  std::string source_format;
  std::vector<std::string> changes;
  std::vector<std::string> unlisted;  // classes or labels that the legend does not have: unknown ground
  std::vector<std::string> on_trust = {}, warnings = {};  // as of ImportedElevation
  std::vector<std::string> cover = {};                    // "unit plain covers 12.3 % of the map"
  PolygonCoordinates coordinates = PolygonCoordinates::kLongitudeLatitude;  // of polygons, as written
};

// What keeps a soil map from being used on any elevation, where the elevation itself can't be.
Result<void> examine_soil(const SoilImport& order);

// Writes the soil map beside the elevation: a class raster as a tiled, compressed GeoTIFF, polygons as
// GeoJSON. What was written has been read back. Errors as above; an empty legend is refused with the classes
// that there are.
Result<ImportedSoil> import_soil(const SoilImport& order, const ElevationInfo& ground,
                                 const std::filesystem::path& out, Progress& progress);

}  // namespace slipway::dem
