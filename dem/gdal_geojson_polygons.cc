// GDAL's JSON parser and its GeoJSON geometry reader, without its GeoJSON dataset: that one leaves out what
// is no feature, so that "/features/12" would name another one, and fetches a CRS that is given by its
// address.

#include "dem/gdal_geojson_polygons.h"

#include <cpl_json.h>
#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <utility>

namespace slipway::dem {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kMaxBytes = 64ULL << 20;  // 160 times the mapped units of Marias Pass

// By name as it is written: GDAL's own look-up takes a slash in a name for a path.
std::optional<CPLJSONObject> member(const CPLJSONObject& object, const std::string& name) {
  if (!object.IsValid() || object.GetType() != CPLJSONObject::Type::Object) return std::nullopt;
  for (const CPLJSONObject& child : object.GetChildren()) {
    if (child.GetName() == name) return child;
  }
  return std::nullopt;
}

std::string text_of(const std::optional<CPLJSONObject>& object) {
  return object && object->GetType() == CPLJSONObject::Type::String ? object->ToString() : std::string();
}

std::optional<std::string> fault_of_ring(const OGRLinearRing& ring, PolygonCoordinates coordinates) {
  if (ring.getNumPoints() < 4)
    return fmt::format("a ring has {} positions, must have at least 4", ring.getNumPoints());
  for (int i = 0; i < ring.getNumPoints(); ++i) {
    const double x = ring.getX(i);
    const double y = ring.getY(i);
    if (!std::isfinite(x) || !std::isfinite(y)) return "a coordinate is not finite";
    if (coordinates == PolygonCoordinates::kMap) continue;
    if (x < -180.0 || x > 360.0) return fmt::format("longitude = {} deg, must be in [-180, 360]", x);
    if (y < -90.0 || y > 90.0) return fmt::format("latitude = {} deg, must be in [-90, 90]", y);
  }
  const int last = ring.getNumPoints() - 1;
  if (ring.getX(0) != ring.getX(last) || ring.getY(0) != ring.getY(last)) return "a ring does not close";
  return std::nullopt;
}

std::optional<std::string> fault_of_polygon(const OGRPolygon& polygon, PolygonCoordinates coordinates) {
  if (polygon.IsEmpty() != FALSE) return "the polygon has no rings";
  for (const OGRLinearRing* ring : polygon) {
    std::optional<std::string> fault = fault_of_ring(*ring, coordinates);
    if (fault) return fault;
  }
  return std::nullopt;
}

std::optional<std::string> fault_of_geometry(const OGRGeometry& geometry, PolygonCoordinates coordinates) {
  if (geometry.getGeometryType() == wkbPolygon) return fault_of_polygon(*geometry.toPolygon(), coordinates);
  if (geometry.IsEmpty() != FALSE) return "the polygon has no rings";
  for (const OGRPolygon* polygon : *geometry.toMultiPolygon()) {
    std::optional<std::string> fault = fault_of_polygon(*polygon, coordinates);
    if (fault) return fault;
  }
  return std::nullopt;
}

class FeatureReader {
 public:
  FeatureReader(const std::string& property, PolygonCoordinates coordinates)
      : property_(property), coordinates_(coordinates) {}

  void read(const CPLJSONObject& feature, int index) {
    const std::string pointer = fmt::format("/features/{}", index);
    if (text_of(member(feature, "type")) != "Feature") {
      add(pointer, "is not a Feature");
      return;
    }
    std::unique_ptr<OGRGeometry> geometry = read_geometry(feature, pointer + "/geometry");
    const std::optional<std::string> label = read_label(feature, pointer + "/properties");
    if (geometry && label) polygons_.push_back({*label, std::move(geometry)});
  }

  std::vector<Fault> take_faults() { return std::move(faults_); }
  std::vector<LabelledPolygon> take_polygons() { return std::move(polygons_); }

 private:
  void add(std::string pointer, std::string message) {
    faults_.push_back({std::move(pointer), std::move(message)});
  }

  std::unique_ptr<OGRGeometry> read_geometry(const CPLJSONObject& feature, const std::string& pointer) {
    const std::optional<CPLJSONObject> json = member(feature, "geometry");
    const std::string type = json ? text_of(member(*json, "type")) : "";
    if (type != "Polygon" && type != "MultiPolygon") {
      add(pointer, fmt::format("type = {}, must be Polygon or MultiPolygon", type.empty() ? "null" : type));
      return nullptr;
    }
    CPLErrorReset();
    std::unique_ptr<OGRGeometry> geometry(OGRGeometryFactory::createFromGeoJson(*json));
    if (!geometry || CPLGetLastErrorType() >= CE_Failure) {
      add(pointer, fmt::format("is malformed: {}", CPLGetLastErrorMsg()));
      return nullptr;
    }
    geometry->flattenTo2D();
    std::optional<std::string> fault = fault_of_geometry(*geometry, coordinates_);
    if (!fault) return geometry;
    add(pointer, std::move(*fault));
    return nullptr;
  }

  std::optional<std::string> read_label(const CPLJSONObject& feature, const std::string& pointer) {
    const std::optional<CPLJSONObject> properties = member(feature, "properties");
    const std::optional<CPLJSONObject> label = properties ? member(*properties, property_) : std::nullopt;
    if (label) {
      switch (label->GetType()) {
        case CPLJSONObject::Type::String:
        case CPLJSONObject::Type::Integer:
        case CPLJSONObject::Type::Long:
          return label->ToString();
        default:
          break;
      }
    }
    add(pointer,
        fmt::format("{} is {}, must be a text or a whole number", property_, label ? "neither" : "absent"));
    return std::nullopt;
  }

  const std::string& property_;
  PolygonCoordinates coordinates_;
  std::vector<LabelledPolygon> polygons_;
  std::vector<Fault> faults_;
};

}  // namespace

Result<std::vector<LabelledPolygon>> read_geojson_polygons(const fs::path& path, const std::string& property,
                                                           PolygonCoordinates coordinates,
                                                           const GdalSession& session) {
  const std::string file = path.filename().string();
  std::error_code problem;
  if (!fs::is_regular_file(path, problem)) {
    return fail(ErrorCode::kUnreadableData, fmt::format("{} is not a regular file that can be read.", file));
  }
  const std::uintmax_t bytes = fs::file_size(path, problem);
  if (problem || bytes > kMaxBytes) {
    return fail(ErrorCode::kUnreadableData,
                fmt::format("{} has {} bytes, must have at most {}.", file, bytes, kMaxBytes));
  }
  CPLJSONDocument document;
  if (!document.Load(fs::canonical(path, problem).string())) {
    const std::string reason = session.complaints();
    return fail(ErrorCode::kUnreadableData, fmt::format("{} is not JSON: {}", file, reason), {{"", reason}});
  }
  const CPLJSONObject root = document.GetRoot();
  const std::optional<CPLJSONObject> features = member(root, "features");
  if (text_of(member(root, "type")) != "FeatureCollection" || !features ||
      features->GetType() != CPLJSONObject::Type::Array) {
    return fail(ErrorCode::kUnreadableData, fmt::format("{} is not a GeoJSON FeatureCollection.", file),
                {{"", "must be a FeatureCollection with an array of features"}});
  }
  FeatureReader reader(property, coordinates);
  const CPLJSONArray array = features->ToArray();
  for (int i = 0; i < array.Size(); ++i) reader.read(array[i], i);
  std::vector<Fault> faults = reader.take_faults();
  if (!faults.empty()) {
    const std::string detail = fmt::format("{} has {} faults.", file, faults.size());
    return fail(ErrorCode::kUnreadableData, detail, std::move(faults));
  }
  return reader.take_polygons();
}

}  // namespace slipway::dem
