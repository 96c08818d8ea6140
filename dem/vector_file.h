#pragma once

#include <array>
#include <string>
#include <variant>
#include <vector>

#include "core/result.h"

namespace slipway::dem {

// Nothing where it is not known, a number, or a text.
using VectorValue = std::variant<std::monostate, double, std::string>;

struct VectorField {
  std::string name;
  bool is_text = false;
};

struct VectorFeature {
  std::vector<std::array<double, 3>> points;  // x, y (m of the map) and height (m); one of a point layer
  std::vector<VectorValue> values;            // of the layer's fields, in their order
};

// Points, or lines; a line of fewer than two points has no geometry.
struct VectorLayer {
  std::string name;
  bool lines = false;
  std::vector<VectorField> fields;
  std::vector<VectorFeature> features;
  std::string style_qml = {};  // as QGIS takes it from a GeoPackage by itself; empty: none
};

// A GeoPackage's bytes. crs_wkt: of the map; empty: a local frame. The same layers give the same bytes.
// Errors: internal, with GDAL's reasons.
Result<std::string> encode_geopackage(const std::vector<VectorLayer>& layers, const std::string& crs_wkt);

}  // namespace slipway::dem
