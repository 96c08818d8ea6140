#pragma once

#include <ogr_geometry.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/result.h"
#include "dem/gdal_session.h"
#include "dem/soil_map.h"

namespace slipway::dem {

// One feature of a file: the value of its property, and its Polygon or MultiPolygon in the file's
// coordinates.
struct LabelledPolygon {
  std::string label;
  std::unique_ptr<OGRGeometry> geometry;
};

// Reads a GeoJSON FeatureCollection. Its own "crs" member is ignored, since it would name a datum of the
// Earth or an address from which to fetch one. Everything that is wrong is reported together: syntax,
// geometry types, rings that don't close, coordinates that are not finite or not degrees, a property that is
// absent.
Result<std::vector<LabelledPolygon>> read_geojson_polygons(const std::filesystem::path& path,
                                                           const std::string& property,
                                                           PolygonCoordinates coordinates,
                                                           const GdalSession& session);

}  // namespace slipway::dem
