#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/result.h"
#include "dem/gdal_geojson_polygons.h"
#include "dem/soil_legend.h"

namespace slipway::dem {

// Reads a file of units by its ending (see is_unit_file()): a GeoPackage or a Shapefile from a copy in
// memory, so that nothing beside it is made, anything else as GeoJSON. Of a GeoPackage the one layer of
// polygons that has the property. Features without a geometry are passed over and noted, heights of places
// too. Errors: as read_geojson_units(), with the features' own numbers.
Result<SoilUnits> read_soil_units(const std::filesystem::path& path, const std::string& property,
                                  PolygonCoordinates stated, const GdalSession& session);

// Brings units into the elevation's system and onto the sheet of its map: longitudes that differ by 360 deg
// are one place, edges in degrees are straight in degrees [RFC 7946, 3.1.1], and a ring with a step of more
// than 180 deg, but not all the way round, goes over the antimeridian. Adds to the notes. Errors:
// unsupported_crs of another body's system, unreadable_data with the features that the map can't show.
Result<void> bring_to_map(SoilUnits& units, const ElevationInfo& ground, const std::string& file,
                          const GdalSession& session);

// The units as GeoJSON in metres of the map that they were brought to, with this one property.
std::string geojson_of(const SoilUnits& units, const std::string& property);

// A file of units as it becomes the soil map of a terrain.
struct ImportedUnits {
  std::string format;               // "Shapefile"
  std::vector<std::string> labels;  // that the file has, each once
  std::vector<std::string> notes;
  SoilCover cover;
  bool in_map_metres = false;  // what was written, whatever the file was in
};

// Writes the units to `out` as GeoJSON: a GeoJSON file as it is, any other in metres of the map. With an
// empty legend nothing is written and there is no cover. Errors: those of read_soil_units() and
// read_soil_polygons(), unwritable_file.
Result<ImportedUnits> import_soil_units(const std::filesystem::path& source, const std::string& property,
                                        PolygonCoordinates stated, const std::vector<SoilClass>& legend,
                                        const ElevationInfo& ground, const std::filesystem::path& out);

}  // namespace slipway::dem
