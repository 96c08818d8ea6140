#include "api/export/answer_vectors.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include "api/json/faults.h"
#include "api/json/lookup.h"
#include "api/json/parse.h"
#include "api/json/writer.h"
#include "dem/body_degrees.h"
#include "dem/vector_file.h"

namespace slipway::api::json {
namespace {

using dem::VectorFeature;
using dem::VectorLayer;

Result<JsonValue> read_answer_document(std::string_view document) {
  return parse(document, {.bytes = document.size(), .values = document.size()});
}

// Turns every point to degrees. Errors: unsupported_crs.
Result<void> turn_to_degrees(std::vector<VectorFeature>& features, const dem::BodyDegrees& degrees) {
  for (VectorFeature& feature : features) {
    for (auto& point : feature.points) {
      const auto place = degrees.to_degrees({point[0], point[1]});
      if (!place)
        return fail(ErrorCode::kUnsupportedCrs,
                    "This terrain's map has no longitude and latitude: it lies on no body.");
      point = {place->x, place->y, point[2]};
    }
  }
  return {};
}

// A name under which tools find the body's longitude and latitude; none is known for other spheres.
std::string degrees_name(const AnswerMap& map) {
  if (map.body == "Mars" && map.semi_major_axis_m == 3'396'190.0) return "urn:ogc:def:crs:IAU_2015::49900";
  if (map.body == "Moon" && map.semi_major_axis_m == 1'737'400.0) return "urn:ogc:def:crs:IAU_2015::30100";
  return {};
}

std::string in_words(const AnswerMap& map, VectorCoordinates coordinates) {
  if (coordinates == VectorCoordinates::kMap)
    return fmt::format("x_m, y_m, height_m in {}; these are no degrees", map.crs_name);
  const std::string place = map.body == "other" ? std::string("a body of its own") : map.body;
  return fmt::format(
      "longitude (to the east) and {} latitude in degrees on {}, semi-major axis {} m; height_m{}",
      map.body == "Earth" ? "geodetic" : "planetocentric", place, map.semi_major_axis_m,
      map.body == "Earth" ? "" : ". This is not the Earth: a tool that takes it for WGS 84 is wrong");
}

void write_point(Writer& w, const std::array<double, 3>& point, VectorCoordinates coordinates) {
  w.begin_array();
  if (coordinates == VectorCoordinates::kMap) {
    w.metres(point[0]).metres(point[1]);
  } else {
    for (const int i : {0, 1}) w.exact(std::round(point[static_cast<std::size_t>(i)] * 1e9) / 1e9);
  }
  w.metres(point[2]).end_array();
}

void write_geometry(Writer& w, const VectorLayer& layer, const VectorFeature& feature,
                    VectorCoordinates coordinates) {
  w.key("geometry");
  if (layer.lines && feature.points.size() < 2) {
    w.null();
    return;
  }
  w.begin_object().text("type", layer.lines ? "LineString" : "Point").key("coordinates");
  if (layer.lines) w.begin_array();
  for (const auto& point : feature.points) write_point(w, point, coordinates);
  if (layer.lines) w.end_array();
  w.end_object();
}

// What one feature of a layer is called: "route" of "routes".
std::string feature_name(const VectorLayer& layer) {
  return layer.name.ends_with('s') ? layer.name.substr(0, layer.name.size() - 1) : layer.name;
}

void write_features(Writer& w, const VectorLayer& layer, const std::vector<VectorFeature>& features,
                    VectorCoordinates coordinates) {
  for (const VectorFeature& feature : features) {
    if (feature.points.empty() && layer.name == "rules") continue;  // trips nowhere
    w.begin_object().text("type", "Feature");
    write_geometry(w, layer, feature, coordinates);
    w.key("properties").begin_object().text("layer", feature_name(layer));
    for (std::size_t i = 0; i < layer.fields.size(); ++i) {
      if (const auto* const number = std::get_if<double>(&feature.values[i]))
        w.exact(layer.fields[i].name, *number);
      if (const auto* const words = std::get_if<std::string>(&feature.values[i]))
        w.text(layer.fields[i].name, *words);
    }
    w.end_object().end_object();
  }
}

Result<void> write_layers_geojson(std::vector<VectorLayer> layers, const AnswerMap& map,
                                  VectorCoordinates coordinates, const ByteSink& out) {
  const bool in_degrees = coordinates == VectorCoordinates::kLongitudeLatitude;
  const dem::BodyDegrees degrees(map.crs_wkt, map.body, map.extent);
  Writer w;
  const auto write = [&](const VectorLayer& layer, std::vector<VectorFeature>& features) -> Result<void> {
    if (in_degrees)
      if (auto turned = turn_to_degrees(features, degrees); !turned) return turned;
    write_features(w, layer, features, coordinates);
    return out(w.take());
  };
  w.begin_object().text("type", "FeatureCollection").text("coordinates", in_words(map, coordinates));
  w.text("body", map.body);
  if (const std::string name = in_degrees ? degrees_name(map) : map.crs_wkt; !name.empty()) {
    w.key("crs").begin_object().text("type", "name");
    w.key("properties").begin_object().text("name", name).end_object().end_object();
  }
  w.key("features").begin_array();
  for (VectorLayer& layer : layers) {
    if (auto written = write(layer, layer.features); !written) return written;
    while (layer.more) {
      auto some = layer.more();
      if (!some) return fail(some.error());
      if (some->empty()) break;
      if (auto written = write(layer, *some); !written) return written;
    }
  }
  w.end_array().end_object();
  return out(w.take() + "\n");
}

Result<std::string> in_memory(const std::function<Result<void>(const ByteSink&)>& write) {
  std::string all;
  const auto written = write([&](std::string_view bytes) -> Result<void> {
    all += bytes;
    return {};
  });
  if (!written) return fail(written.error());
  return all;
}

dem::Extent extent_of(const JsonValue& site) {
  const JsonValue& extent = at(site, "extent");
  return {number(extent, "west_m"), number(extent, "south_m"), number(extent, "east_m"),
          number(extent, "north_m")};
}

}  // namespace

Result<AnswerMap> map_of_terrain(std::string_view terrains, std::string_view terrain) {
  const auto document = read_answer_document(terrains);
  if (!document) return fail(document.error());
  for (const JsonValue& site : at(*document, "terrains").elements)
    if (text(site, "name") == terrain)
      return AnswerMap{text(site, "crs_name"), text(site, "crs_wkt"), text(site, "body"),
                       number(site, "semi_major_axis_m"), extent_of(site)};
  return fail(ErrorCode::kNotFound, fmt::format("There is no terrain {}.", in_quotes(terrain)));
}

AnsweredTerrain terrain_of_answer(std::string_view answer) {
  const auto document = read_answer_document(answer);
  if (!document) return {};
  return {text(*document, "terrain"), text(at(*document, "provenance"), "terrain_version")};
}

Result<void> write_answer_geojson(std::string_view answer, const AnswerMap& map,
                                  VectorCoordinates coordinates, TablePages stations, const ByteSink& out) {
  auto layers = answer_layers(answer, std::move(stations));
  if (!layers) return fail(layers.error());
  return write_layers_geojson(*std::move(layers), map, coordinates, out);
}

Result<std::string> answer_geojson(std::string_view answer, const AnswerMap& map,
                                   VectorCoordinates coordinates, TablePages stations) {
  return in_memory([&](const ByteSink& out) {
    return write_answer_geojson(answer, map, coordinates, std::move(stations), out);
  });
}

Result<std::string> layers_geojson(std::vector<VectorLayer> layers, const AnswerMap& map,
                                   VectorCoordinates coordinates) {
  return in_memory(
      [&](const ByteSink& out) { return write_layers_geojson(std::move(layers), map, coordinates, out); });
}

Result<std::string> answer_geopackage(std::string_view answer, const AnswerMap& map, TablePages stations) {
  const auto layers = answer_layers(answer, std::move(stations));
  if (!layers) return fail(layers.error());
  return dem::encode_geopackage(*layers, map.crs_wkt);
}

Result<void> write_answer_geopackage(std::string_view answer, const AnswerMap& map, TablePages stations,
                                     const std::string& path) {
  const auto layers = answer_layers(answer, std::move(stations));
  if (!layers) return fail(layers.error());
  return dem::write_geopackage(path, *layers, map.crs_wkt);
}

}  // namespace slipway::api::json
