#pragma once

#include <optional>
#include <string>
#include <vector>

#include "dem/soil_map.h"

namespace slipway::api {

enum class SoilSource {
  kNone,      // all of it is unknown ground
  kRaster,    // a class raster
  kPolygons,  // a GeoJSON file of units
};

// How far the ground may be from the map, as a terrain or a request states it: see sim::ReliefSpread, whose
// values stand where these are empty.
struct ReliefValues {
  std::optional<double> elevation_error_m = {}, error_length_m = {};
  std::optional<double> roughness_m = {}, roughness_length_m = {};
  std::optional<double> rock_share = {}, min_rock_m = {}, max_rock_m = {};
};

// One reading of a map's classes: which soil each is believed to be, and why.
struct Legend {
  std::string name = "default";
  std::vector<dem::SoilClass> classes;
  std::string assumption;   // why these classes are believed to be these soils
  double confidence = 1.0;  // the probability that a class is the soil that the legend gives
};

// What terrain.json says of a terrain. File names are plain names inside the terrain's own folder.
struct TerrainDescription {
  std::string name;
  std::string title;
  std::string elevation_file;
  double gravity_m_s2 = 0.0;
  SoilSource soil_source = SoilSource::kNone;
  std::string soil_file;
  std::string soil_property;  // of the polygons: which property is the label
  dem::PolygonCoordinates soil_coordinates = dem::PolygonCoordinates::kMap;
  std::vector<Legend> legends = {Legend{}};  // the first is used where a request names none
  ReliefValues relief;                       // drawn where a request asks for it
  std::optional<std::string> stops_file;
  std::optional<std::string> outcomes_file;  // how drives on this ground ended
  std::optional<std::string> steps_file;     // slip that was measured on this ground
  std::optional<std::string> provenance_file;

  // By its name, the first where that is empty; nullptr where there is none of that name.
  const Legend* legend(const std::string& legend_name) const {
    for (const Legend& each : legends)
      if (legend_name.empty() || each.name == legend_name) return &each;
    return nullptr;
  }
};

}  // namespace slipway::api
