#pragma once

#include <array>
#include <functional>
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
  // Of a layer that is too long to be held: its features behind those above, some at a time, none after the
  // last. Empty: there are no more.
  std::function<Result<std::vector<VectorFeature>>()> more = nullptr;
};

// Writes a GeoPackage where there is no file yet. crs_wkt: of the map; empty: a local frame. The same layers
// give the same bytes. Errors: internal, with GDAL's reasons; those of a layer's `more`.
Result<void> write_geopackage(const std::string& path, const std::vector<VectorLayer>& layers,
                              const std::string& crs_wkt);
// The same in memory.
Result<std::string> encode_geopackage(const std::vector<VectorLayer>& layers, const std::string& crs_wkt);

}  // namespace slipway::dem
