// GDAL's JSON parser and its GeoJSON geometry reader, without its GeoJSON dataset: that one leaves out what
// is no feature, so that "/features/12" would name another one, and fetches a CRS that is given by its
// address.

#include "dem/gdal_geojson_polygons.h"

#include <cpl_json.h>
#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <optional>
#include <utility>

#include "core/text_encoding.h"
#include "dem/crs/gdal_named_crs.h"
#include "dem/gdal_crs.h"

namespace slipway::dem {
namespace {

namespace fs = std::filesystem;

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

// RFC 7946, 3.1.9, and files from before it: a polygon over the antimeridian goes on beyond 180 deg.
constexpr double kWest_deg = -360.0, kEast_deg = 720.0;

std::optional<std::string> fault_of_degrees(double x, double y) {
  constexpr const char* kMetres = ": where the file is in map metres, say so (--map-coordinates)";
  const bool swapped = std::abs(x) <= 90.0 && y >= kWest_deg && y <= kEast_deg;
  if (x < kWest_deg || x > kEast_deg)
    return fmt::format("longitude = {} deg, must be in [{}, {}]{}", x, kWest_deg, kEast_deg, kMetres);
  if (y < -90.0 || y > 90.0)
    return fmt::format("latitude = {} deg, must be in [-90, 90]{}", y,
                       swapped ? ": longitude and latitude are swapped, longitude comes first" : kMetres);
  return std::nullopt;
}

std::optional<std::string> fault_of_ring(const OGRLinearRing& ring, UnitPlaces places) {
  if (ring.getNumPoints() < 4)
    return fmt::format("a ring has {} positions, must have at least 4", ring.getNumPoints());
  for (int i = 0; i < ring.getNumPoints(); ++i) {
    const double x = ring.getX(i);
    const double y = ring.getY(i);
    if (!std::isfinite(x) || !std::isfinite(y)) return "a coordinate is not finite";
    if (places != UnitPlaces::kDegrees) continue;
    if (auto fault = fault_of_degrees(x, y)) return fault;
  }
  const int last = ring.getNumPoints() - 1;
  if (ring.getX(0) != ring.getX(last) || ring.getY(0) != ring.getY(last)) return "a ring does not close";
  return std::nullopt;
}

std::optional<std::string> fault_of_polygon(const OGRPolygon& polygon, UnitPlaces places) {
  if (polygon.IsEmpty() != FALSE) return "the polygon has no rings";
  for (const OGRLinearRing* ring : polygon) {
    std::optional<std::string> fault = fault_of_ring(*ring, places);
    if (fault) return fault;
  }
  return std::nullopt;
}

// A number that is whole is a label as its digits: 1.0 is "1", as tables of attributes write it.
std::optional<std::string> whole(double value) {
  if (value != std::round(value) || std::abs(value) > 9e15) return std::nullopt;
  return fmt::format("{:.0f}", value);
}

class FeatureReader {
 public:
  FeatureReader(const std::string& property, UnitPlaces places) : property_(property), places_(places) {}

  void read(const CPLJSONObject& feature, int index) {
    const std::string pointer = fmt::format("/features/{}", index);
    if (text_of(member(feature, "type")) != "Feature") {
      add(pointer, "is not a Feature");
      return;
    }
    const auto there = member(feature, "geometry");
    if (there && there->GetType() == CPLJSONObject::Type::Null) {
      ++without_geometry_;
      return;
    }
    std::unique_ptr<OGRGeometry> geometry = read_geometry(feature, pointer + "/geometry");
    const std::optional<std::string> label = read_label(feature, pointer + "/properties");
    if (geometry && label) polygons_.push_back({*label, std::move(geometry), pointer + "/geometry"});
  }

  int without_geometry() const { return without_geometry_; }
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
    std::optional<std::string> fault = fault_of_geometry(*geometry, places_);
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
        case CPLJSONObject::Type::Double:
          if (auto text = whole(label->ToDouble())) return text;
          break;
        default:
          break;
      }
    }
    add(pointer, fmt::format("{} is {}, must be a text or a whole number{}", property_,
                             label ? "neither" : "absent", label ? "" : names_of(properties)));
    return std::nullopt;
  }

  // What there is in its place.
  static std::string names_of(const std::optional<CPLJSONObject>& properties) {
    std::string names;
    if (properties && properties->GetType() == CPLJSONObject::Type::Object)
      for (const CPLJSONObject& child : properties->GetChildren())
        names += (names.empty() ? "" : ", ") + child.GetName();
    return names.empty() ? names : fmt::format("; the feature has {} (--property)", names);
  }

  const std::string& property_;
  UnitPlaces places_;
  int without_geometry_ = 0;
  std::vector<LabelledPolygon> polygons_;
  std::vector<Fault> faults_;
};

Result<std::string> text_of_file(const fs::path& path, std::vector<std::string>& notes) {
  const std::string file = path.filename().string();
  std::error_code problem;
  if (!fs::is_regular_file(path, problem)) {
    return fail(ErrorCode::kUnreadableData, fmt::format("{} is not a regular file that can be read.", file));
  }
  const std::uintmax_t bytes = fs::file_size(path, problem);
  if (problem || bytes > kMaxVectorBytes) {
    return fail(ErrorCode::kUnreadableData,
                fmt::format("{} has {} bytes, must have at most {}.", file, bytes, kMaxVectorBytes));
  }
  std::ifstream stream(path, std::ios::binary);
  const std::string raw((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
  auto decoded = decode_text(raw);
  if (!decoded)
    return fail(ErrorCode::kUnreadableData, fmt::format("{} is not JSON: it is no text.", file),
                {{"", "is no text"}});
  if (!decoded->note.empty()) notes.push_back(std::move(decoded->note));
  return std::move(decoded->utf8);
}

// Sets the system that the member "crs" names [the GeoJSON of 2008]; none where there is no such member, or
// it is CRS84. What names no known system is refused, but where the file is stated to be in map metres.
Result<void> read_crs(const CPLJSONObject& root, PolygonCoordinates stated, const std::string& file,
                      SoilUnits& units) {
  const auto crs = member(root, "crs");
  if (!crs || crs->GetType() == CPLJSONObject::Type::Null) return {};
  const auto properties = member(*crs, "properties");
  const std::string name = properties ? text_of(member(*properties, "name")) : "";
  if (name.find("CRS84") != std::string::npos) return {};
  auto found = named_crs(name);
  if (name.find("OGC::Engineering") != std::string::npos) {
    found = std::make_unique<OGRSpatialReference>();
    found->SetLocalCS("Engineering");
  } else if (!found) {
    const std::string shown = name.empty() ? "a system without a name" : fmt::format("\"{}\"", name);
    if (stated == PolygonCoordinates::kMap) {
      units.notes.push_back(fmt::format(
          "{} says {}, which is not known: its places were taken as metres of the map, as stated.", file,
          shown));
      return {};
    }
    return fail(ErrorCode::kUnsupportedCrs,
                fmt::format("{} is in {}, which is not known. Save it in longitude and latitude, or in the "
                            "system of the elevation with --map-coordinates.",
                            file, shown),
                {{"/crs", "names no system that is known"}});
  }
  found->SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  units.crs = std::move(found);
  return {};
}

}  // namespace

Result<UnitPlaces> places_of(const OGRSpatialReference* crs, PolygonCoordinates stated,
                             const std::string& file) {
  const bool map = stated == PolygonCoordinates::kMap;
  if (crs == nullptr || crs->IsEmpty() || (map && crs->IsProjected() == 0))
    return map ? UnitPlaces::kMap : UnitPlaces::kDegrees;
  if (is_west_positive(*crs))
    return fail(
        ErrorCode::kUnsupportedCrs,
        fmt::format("{} is in \"{}\", whose longitudes count to the west. Save it in longitudes to the "
                    "east and planetocentric latitudes.",
                    file, crs->GetName()));
  if (crs->IsProjected() != 0) return UnitPlaces::kOwnSystem;
  if (crs->IsGeographic() != 0) return UnitPlaces::kDegrees;
  return fail(
      ErrorCode::kUnsupportedCrs,
      fmt::format("{} is in \"{}\", a local system that has no place on the map. Where its x and y are "
                  "metres of the elevation's map, say so with --map-coordinates; else save it in "
                  "longitude and latitude.",
                  file, crs->GetName()));
}

std::optional<std::string> fault_of_geometry(const OGRGeometry& geometry, UnitPlaces places) {
  if (geometry.getGeometryType() == wkbPolygon) return fault_of_polygon(*geometry.toPolygon(), places);
  if (geometry.IsEmpty() != FALSE) return "the polygon has no rings";
  for (const OGRPolygon* polygon : *geometry.toMultiPolygon()) {
    std::optional<std::string> fault = fault_of_polygon(*polygon, places);
    if (fault) return fault;
  }
  return std::nullopt;
}

Result<SoilUnits> read_geojson_units(const fs::path& path, const std::string& property,
                                     PolygonCoordinates stated, const GdalSession& session) {
  const std::string file = path.filename().string();
  SoilUnits units;
  units.format = "GeoJSON";
  const auto text = text_of_file(path, units.notes);
  if (!text) return fail(text.error());
  CPLJSONDocument document;
  if (!document.LoadMemory(*text)) {
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
  if (const auto crs = read_crs(root, stated, file, units); !crs) return fail(crs.error());
  const auto places = places_of(units.crs.get(), stated, file);
  if (!places) return fail(places.error());
  units.places = *places;
  FeatureReader reader(property, units.places);
  const CPLJSONArray array = features->ToArray();
  for (int i = 0; i < array.Size(); ++i) reader.read(array[i], i);
  std::vector<Fault> faults = reader.take_faults();
  if (!faults.empty()) {
    const std::string detail = fmt::format("{} has {} faults.", file, faults.size());
    return fail(ErrorCode::kUnreadableData, detail, std::move(faults));
  }
  units.polygons = reader.take_polygons();
  if (reader.without_geometry() > 0)
    units.notes.push_back(fmt::format("{} of {} features have no geometry and were passed over.",
                                      reader.without_geometry(), array.Size()));
  return units;
}

}  // namespace slipway::dem
