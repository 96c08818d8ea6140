#include "server/cli/inquiry/zone_option.h"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <optional>
#include <sstream>

#include "api/json/lookup.h"
#include "api/json/parse.h"

namespace slipway::server {
namespace {

using api::json::at;
using api::json::JsonValue;
using api::json::text;
using api::json::Writer;

// "x,y x,y x,y"; nothing where the text is not of that form.
std::optional<JsonValue> ring_of(const std::string& words) {
  JsonValue ring;
  ring.kind = JsonValue::Kind::kArray;
  std::istringstream list(words);
  for (std::string place; list >> place;) {
    std::istringstream parts(place);
    double x_m = 0.0, y_m = 0.0;
    char comma = 0;
    if (!(parts >> x_m >> comma >> y_m) || comma != ',' || !parts.eof()) return std::nullopt;
    JsonValue& corner = ring.elements.emplace_back();
    corner.kind = JsonValue::Kind::kArray;
    for (const double coordinate_m : {x_m, y_m}) {
      JsonValue& coordinate = corner.elements.emplace_back();
      coordinate.kind = JsonValue::Kind::kNumber;
      coordinate.number = coordinate_m;
    }
  }
  if (ring.elements.empty()) return std::nullopt;
  return ring;
}

// The outer rings of a geometry, a feature or a collection. False where there is anything else, or a hole.
bool add_rings(const JsonValue& geojson, std::vector<JsonValue>& rings) {
  const std::string& type = text(geojson, "type");
  const auto polygon = [&](const JsonValue& coordinates) {
    if (coordinates.elements.size() != 1) return false;  // a hole, or nothing
    rings.push_back(coordinates.elements.front());
    for (JsonValue& corner : rings.back().elements)
      if (corner.elements.size() == 3) corner.elements.pop_back();  // the height
    return true;
  };
  bool good = true;
  if (type == "Polygon") return polygon(at(geojson, "coordinates"));
  if (type == "MultiPolygon")
    for (const JsonValue& one : at(geojson, "coordinates").elements) good = polygon(one) && good;
  else if (type == "Feature")
    return add_rings(at(geojson, "geometry"), rings);
  else if (type == "FeatureCollection")
    for (const JsonValue& feature : at(geojson, "features").elements)
      good = add_rings(feature, rings) && good;
  else
    return false;
  return good;
}

Result<std::vector<JsonValue>> rings_of_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return fail(ErrorCode::kUnreadableData, fmt::format("cannot open {}", path));
  const std::string bytes(std::istreambuf_iterator<char>(file), {});
  const auto document = api::json::parse(bytes);
  if (!document) return fail(document.error());
  std::vector<JsonValue> rings;
  if (!add_rings(*document, rings) || rings.empty())
    return fail(ErrorCode::kInvalidRequest, fmt::format("{} must hold GeoJSON polygons without holes", path));
  return rings;
}

}  // namespace

Result<void> write_zone_options(Writer& w, std::string_view key, const std::vector<std::string>& zones) {
  if (zones.empty()) return {};
  w.key(key).begin_array();
  for (std::size_t k = 0; k < zones.size(); ++k) {
    if (const auto ring = ring_of(zones[k])) {
      api::json::write_value(w, *ring);
      continue;
    }
    auto rings = rings_of_file(zones[k]);
    if (!rings) {
      Error error = rings.error();
      error.faults.push_back({fmt::format("/{}/{}", key, k),
                              fmt::format("\"{}\" must be corners \"x,y x,y x,y\" or a GeoJSON file: {}",
                                          zones[k], error.detail)});
      error.code = ErrorCode::kInvalidRequest;
      return fail(std::move(error));
    }
    for (const JsonValue& ring : *rings) api::json::write_value(w, ring);
  }
  w.end_array();
  return {};
}

}  // namespace slipway::server
