#pragma once

#include <ogr_geometry.h>
#include <ogr_spatialref.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/result.h"
#include "dem/gdal_session.h"
#include "dem/soil_map.h"

namespace slipway::dem {

constexpr std::uintmax_t kMaxVectorBytes = 64ULL << 20;  // 160 times the mapped units of Marias Pass

// One feature of a file: the value of its property, and its Polygon or MultiPolygon in the file's
// coordinates.
struct LabelledPolygon {
  std::string label;
  std::unique_ptr<OGRGeometry> geometry;
  std::string pointer = {};  // "/features/12/geometry"
};

// What the coordinates of a file are.
enum class UnitPlaces {
  kDegrees,    // longitude and latitude on the elevation's own body
  kMap,        // metres in the elevation's system
  kOwnSystem,  // a projected system that the file names
};

// A file of units as it was read, before it is brought to a map.
struct SoilUnits {
  std::vector<LabelledPolygon> polygons = {};
  UnitPlaces places = UnitPlaces::kDegrees;
  std::unique_ptr<OGRSpatialReference> crs = {};  // null where the file names none
  std::string format = {};                        // "GeoJSON"
  std::vector<std::string> notes = {};            // what was passed over or taken on trust, each a sentence
};

// What coordinates are that are stated to be `stated` in a file of this system (null: it names none). Errors:
// unsupported_crs of a local system and of a west-positive one, where the file is not stated to be in map
// metres.
Result<UnitPlaces> places_of(const OGRSpatialReference* crs, PolygonCoordinates stated,
                             const std::string& file);

// What is wrong with a polygon or multipolygon: rings that don't close, coordinates that are not finite, or
// not degrees where they must be.
std::optional<std::string> fault_of_geometry(const OGRGeometry& geometry, UnitPlaces places);

// Reads a GeoJSON FeatureCollection in any encoding. Its member "crs" is honoured, without looking anything
// up on a network; CRS84, which every tool writes, is longitude and latitude of whatever body the map is of.
// Features without a geometry are passed over and noted. Everything that is wrong is reported together:
// syntax, geometry types, rings that don't close, coordinates that are not finite or not degrees, a property
// that is absent.
Result<SoilUnits> read_geojson_units(const std::filesystem::path& path, const std::string& property,
                                     PolygonCoordinates stated, const GdalSession& session);

}  // namespace slipway::dem
