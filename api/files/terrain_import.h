#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "api/files/catalogue.h"
#include "core/confined_child.h"
#include "core/progress.h"
#include "core/result.h"
#include "dem/soil_map.h"

namespace slipway::api {

// A map that is to become a terrain of the data folder.
struct TerrainImport {
  std::filesystem::path data, elevation;
  std::string crs;  // stands for the map's own; empty: as the map says
  std::optional<std::filesystem::path>
      soil;  // a class raster, or polygons of units (see dem::is_unit_file())
  std::optional<std::filesystem::path> legend;  // CSV: value,label,soil and where known rock_share
  std::string property = "unit";                // of the polygons: which property is the label
  dem::PolygonCoordinates coordinates = dem::PolygonCoordinates::kLongitudeLatitude;
  std::string assumption;              // why these classes are believed to be these soils
  std::string name;                    // empty: made of the map's file name
  std::string title, licence, source;  // empty: not stated
  std::optional<double> gravity_m_s2;  // else the body's, where it is Mars, the Moon or the Earth
  int band = 0;                        // of heights; 0: the only one, or the one described so
  std::string unit;                    // of heights, in place of the file's
  std::optional<double> nodata;        // also marks a missing height
  bool fix = false;                    // mends what can be mended
  bool strict = false;                 // refuses what would be warned of
  // Whether the folder of a terrain of this name may be replaced; empty: none may.
  std::function<bool(const std::filesystem::path& there)> may_replace = nullptr;
  ChildLimits limits = {};
  std::string origin = {};  // bytes of upload.json in the terrain's folder; empty: there is no such file
};

// What was made, for a person to read and for a script.
struct TerrainImportReport {
  std::filesystem::path folder;
  std::string text;
  std::string json;  // "terrain-import/1"
};

// Makes terrains/NAME in the data folder: elevation.tif, the soil map, terrain.json and PROVENANCE.md. The
// maps are read in a child process with limits (see run_confined()), in a folder beside the others whose name
// hides it, and which takes its place when all of it is written and its maps have been read back. Whatever
// ends the work, nothing of it is left behind. Errors: invalid_request with all faults of the order and of
// the legend together; conflict where a terrain that may not be replaced was made meanwhile; those of
// dem::import_elevation(), dem::import_soil() and run_confined().
Result<TerrainImportReport> import_terrain(const TerrainImport& order, const Catalogue& catalogue,
                                           Progress& progress);

}  // namespace slipway::api
