#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "api/export/answer_layers.h"
#include "core/result.h"
#include "dem/grid_geometry.h"
#include "dem/vector_file.h"

// Routes and stations of an answer as vectors for GIS tools.
namespace slipway::api::json {

// The map that an answer's coordinates are on.
struct AnswerMap {
  std::string crs_name, crs_wkt;  // crs_wkt is empty in a local frame
  std::string body;
  double semi_major_axis_m = 0.0;
  std::optional<dem::Extent> extent = {};  // where longitudes go on beyond 180 deg, it says which x is meant
};

// The map of a terrain, from the document that GET /v1/terrains answers. Errors: not_found.
Result<AnswerMap> map_of_terrain(std::string_view terrains, std::string_view terrain);
// The terrain that a "check/1", "prediction/1" or "plan/1" document is about, and its TerrainSite::version().
struct AnsweredTerrain {
  std::string name, version;
};
AnsweredTerrain terrain_of_answer(std::string_view answer);

enum class VectorCoordinates {
  kMap,                // metres of the map, with its system in the member crs
  kLongitudeLatitude,  // degrees of the body, east-positive; planetocentric but on the Earth
};

// Takes the bytes of a document that is too long to be held, in their order. An error ends it.
using ByteSink = std::function<Result<void>(std::string_view)>;

// A FeatureCollection: a line for each route and a point for each station, which the property layer tells
// apart; of checks and predictions also the stretches where rules trip and the places where slip is checked.
// `stations` is the table of all stations where the answer has but some of them; empty: the answer's own. The
// member "coordinates" says in words what the numbers are; "crs" names the system where it has a
// name that tools know. Errors: no_data where the answer has no stations; unsupported_crs for degrees of a
// map that lies on no body; those of `stations` and of `out`.
Result<void> write_answer_geojson(std::string_view answer, const AnswerMap& map,
                                  VectorCoordinates coordinates, TablePages stations, const ByteSink& out);
Result<std::string> answer_geojson(std::string_view answer, const AnswerMap& map,
                                   VectorCoordinates coordinates, TablePages stations = nullptr);
// The same of any layers in map metres; each feature's property layer is its layer's name in the singular.
Result<std::string> layers_geojson(std::vector<dem::VectorLayer> layers, const AnswerMap& map,
                                   VectorCoordinates coordinates);
// A GeoPackage with the layers routes, stations, rules and checks, in map metres, with styles for QGIS.
// Errors: no_data; internal; those of `stations`.
Result<std::string> answer_geopackage(std::string_view answer, const AnswerMap& map,
                                      TablePages stations = nullptr);
// The same in a file that is not there yet.
Result<void> write_answer_geopackage(std::string_view answer, const AnswerMap& map, TablePages stations,
                                     const std::string& path);

}  // namespace slipway::api::json
