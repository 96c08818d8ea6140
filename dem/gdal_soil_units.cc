#include "dem/gdal_soil_units.h"

#include <cpl_conv.h>
#include <cpl_json.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gdal_priv.h>
#include <ogrsf_frmts.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <fstream>
#include <iterator>
#include <mutex>
#include <set>
#include <utility>

#include "core/text_encoding.h"
#include "dem/body_degrees.h"
#include "dem/gdal_memory_file.h"

namespace slipway::dem {
namespace {

namespace fs = std::filesystem;

std::string small_letters(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

void register_vector_formats() {
  static std::once_flag once;
  std::call_once(once, [] {
    RegisterOGRShape();
    RegisterOGRGeoPackage();
  });
}

// A copy of a file, and of those beside it that are of one map with it, in GDAL's memory.
class MemoryCopy {
 public:
  MemoryCopy() : base_(GdalMemoryFile("").name()) {}
  ~MemoryCopy() {
    for (const std::string& name : names_) VSIUnlink(name.c_str());
  }
  MemoryCopy(const MemoryCopy&) = delete;
  MemoryCopy& operator=(const MemoryCopy&) = delete;

  std::string name(const std::string& ending) const { return base_ + ending; }
  bool has(const std::string& ending) const { return names_.count(name(ending)) != 0; }

  Result<void> add(const fs::path& path, const std::string& ending) {
    std::error_code problem;
    const auto bytes = fs::file_size(path, problem);
    if (problem || !fs::is_regular_file(path, problem) || bytes > kMaxVectorBytes)
      return fail(ErrorCode::kUnreadableData,
                  fmt::format("{} is no regular file of at most {} bytes that can be read.",
                              path.filename().string(), kMaxVectorBytes));
    std::ifstream stream(path, std::ios::binary);
    const std::string text((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
    VSILFILE* const file = VSIFOpenL(name(ending).c_str(), "wb");
    if (file == nullptr) return fail(ErrorCode::kInternal, "There is no memory for a soil map.");
    names_.insert(name(ending));
    const bool complete = VSIFWriteL(text.data(), 1, text.size(), file) == text.size();
    VSIFCloseL(file);
    if (!complete) return fail(ErrorCode::kInternal, "There is no memory for a soil map.");
    return {};
  }

 private:
  std::string base_;
  std::set<std::string> names_;
};

Result<void> copy_map(const fs::path& path, MemoryCopy& copy) {
  const std::string ending = small_letters(path.extension().string());
  if (const auto added = copy.add(path, ending); !added) return added;
  if (ending != ".shp") return {};
  std::error_code problem;
  for (const fs::directory_entry& entry :
       fs::directory_iterator(path.parent_path().empty() ? "." : path.parent_path(), problem)) {
    const std::string other = small_letters(entry.path().extension().string());
    if (entry.path().stem() != path.stem() ||
        (other != ".shx" && other != ".dbf" && other != ".prj" && other != ".cpg"))
      continue;
    if (const auto added = copy.add(entry.path(), other); !added) return added;
  }
  if (!copy.has(".dbf"))
    return fail(ErrorCode::kUnreadableData,
                fmt::format("There is no {}.dbf beside {}: it holds the labels of the units.",
                            path.stem().string(), path.filename().string()));
  return {};
}

bool has_polygons(OGRLayer& layer) {
  const OGRwkbGeometryType type = wkbFlatten(layer.GetGeomType());
  return type == wkbUnknown || OGR_GT_IsSubClassOf(type, wkbCurvePolygon) != FALSE ||
         OGR_GT_IsSubClassOf(type, wkbMultiSurface) != FALSE;
}

// The attribute of a layer that is the label; a Shapefile keeps ten letters of a name. -1: none.
int field_of(OGRLayer& layer, const std::string& property) {
  constexpr std::size_t kLettersOfShapefile = 10;
  const int field = layer.GetLayerDefn()->GetFieldIndex(property.c_str());
  if (field >= 0 || property.size() <= kLettersOfShapefile) return field;
  return layer.GetLayerDefn()->GetFieldIndex(property.substr(0, kLettersOfShapefile).c_str());
}

// The one layer of polygons with the property.
Result<OGRLayer*> layer_of(GDALDataset& dataset, const std::string& property, const std::string& file) {
  std::vector<OGRLayer*> found;
  std::vector<std::string> fields, names;
  for (OGRLayer* const layer : dataset.GetLayers()) {
    if (!has_polygons(*layer)) continue;
    OGRFeatureDefn& attributes = *layer->GetLayerDefn();
    for (int i = 0; i < attributes.GetFieldCount(); ++i)
      fields.emplace_back(attributes.GetFieldDefn(i)->GetNameRef());
    if (field_of(*layer, property) < 0) continue;
    found.push_back(layer);
    names.emplace_back(layer->GetName());
  }
  if (found.size() == 1) return found.front();
  if (found.empty())
    return fail(
        ErrorCode::kUnreadableData,
        fmt::format("{} has no layer of polygons with the property {}{}", file, property,
                    fields.empty() ? std::string(".")
                                   : fmt::format("; there are {} (--property).", fmt::join(fields, ", "))));
  return fail(ErrorCode::kUnreadableData,
              fmt::format("{} has {} layers of polygons with the property {}: {}. Save one of them alone.",
                          file, found.size(), property, fmt::join(names, ", ")));
}

// The label of a feature: a text, or a number that is whole.
std::optional<std::string> label_of(const OGRFeature& feature, int field) {
  if (!feature.IsFieldSetAndNotNull(field)) return std::nullopt;
  if (feature.GetFieldDefnRef(field)->GetType() == OFTReal) {
    const double value = feature.GetFieldAsDouble(field);
    if (value != std::round(value) || std::abs(value) > 9e15) return std::nullopt;
    return fmt::format("{:.0f}", value);
  }
  const auto text = decode_text(feature.GetFieldAsString(field));
  return text ? std::optional(text->utf8) : std::nullopt;
}

// As polygons with straight edges and without heights; null where it is none.
std::unique_ptr<OGRGeometry> flat_polygon(const OGRGeometry& geometry) {
  std::unique_ptr<OGRGeometry> flat(geometry.getLinearGeometry());
  if (!flat) return nullptr;
  flat->flattenTo2D();
  const OGRwkbGeometryType type = flat->getGeometryType();
  if (type == wkbPolygon || type == wkbMultiPolygon) return flat;
  return nullptr;
}

void read_feature(const OGRFeature& feature, int field, const std::string& property, SoilUnits& units,
                  int& without_geometry, std::vector<Fault>& faults) {
  const std::string pointer = fmt::format("/features/{}", feature.GetFID());
  const OGRGeometry* const geometry = feature.GetGeometryRef();
  if (geometry == nullptr || geometry->IsEmpty() != FALSE) {
    ++without_geometry;
    return;
  }
  auto flat = flat_polygon(*geometry);
  std::optional<std::string> wrong;
  if (!flat)
    wrong = fmt::format("is a {}, must be a polygon or multipolygon", geometry->getGeometryName());
  else
    wrong = fault_of_geometry(*flat, units.places);
  if (wrong) faults.push_back({pointer + "/geometry", *wrong});
  auto label = label_of(feature, field);
  if (!label) faults.push_back({pointer + "/properties", property + " is no text and no whole number"});
  if (!wrong && label) units.polygons.push_back({*std::move(label), std::move(flat), pointer + "/geometry"});
}

Result<SoilUnits> read_layer(OGRLayer& layer, const std::string& property, PolygonCoordinates stated,
                             const std::string& file) {
  SoilUnits units;
  if (const OGRSpatialReference* const crs = layer.GetSpatialRef()) {
    units.crs.reset(crs->Clone());
    units.crs->SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  } else if (stated == PolygonCoordinates::kLongitudeLatitude) {
    units.notes.push_back(
        fmt::format("{} names no system: its places were taken as longitude and latitude.", file));
  }
  const auto places = places_of(units.crs.get(), stated, file);
  if (!places) return fail(places.error());
  units.places = *places;
  std::vector<Fault> faults;
  int without_geometry = 0, count = 0;
  const int field = field_of(layer, property);
  for (const auto& feature : layer) {
    ++count;
    read_feature(*feature, field, property, units, without_geometry, faults);
  }
  if (!faults.empty()) {
    const std::string detail = fmt::format("{} has {} faults.", file, faults.size());
    return fail(ErrorCode::kUnreadableData, detail, std::move(faults));
  }
  if (without_geometry > 0)
    units.notes.push_back(
        fmt::format("{} of {} features have no geometry and were passed over.", without_geometry, count));
  return units;
}

// Where units are that cover nothing of the map, and what was probably meant.
std::string where_units_lie(const SoilUnits& units, const ElevationInfo& ground) {
  if (units.polygons.empty()) return "; the file has no polygons";
  OGREnvelope box;
  for (const LabelledPolygon& polygon : units.polygons) {
    OGREnvelope one;
    polygon.geometry->getEnvelope(&one);
    box.Merge(one);
  }
  const Extent map = ground.geometry.extent();
  std::string text = fmt::format("; the units have x of {:.6g} to {:.6g} and y of {:.6g} to {:.6g}", box.MinX,
                                 box.MaxX, box.MinY, box.MaxY);
  text += fmt::format(", the map has x of {:.6g} to {:.6g} m and y of {:.6g} to {:.6g} m", map.west_m,
                      map.east_m, map.south_m, map.north_m);
  const BodyDegrees degrees(ground.crs_wkt, ground.body, map);
  const MapPlace middle{0.5 * (map.west_m + map.east_m), 0.5 * (map.south_m + map.north_m)};
  const auto on_body = degrees.to_degrees(middle);
  if (on_body) text += fmt::format(" around {:.6g} deg E, {:.6g} deg N", on_body->x, on_body->y);
  const double x = 0.5 * (box.MinX + box.MaxX), y = 0.5 * (box.MinY + box.MaxY);
  return text +
         likely_mistake(ground.crs_wkt, ground.body, map, {x, y}, units.places == UnitPlaces::kDegrees);
}

}  // namespace

bool is_unit_file(const fs::path& path) {
  const std::string ending = small_letters(path.extension().string());
  return ending == ".geojson" || ending == ".json" || ending == ".shp" || ending == ".gpkg";
}

Result<SoilUnits> read_soil_units(const fs::path& path, const std::string& property,
                                  PolygonCoordinates stated, const GdalSession& session) {
  const std::string ending = small_letters(path.extension().string()), file = path.filename().string();
  if (ending != ".shp" && ending != ".gpkg") return read_geojson_units(path, property, stated, session);
  register_vector_formats();
  MemoryCopy copy;
  if (const auto copied = copy_map(path, copy); !copied) return fail(copied.error());
  const char* const drivers[] = {ending == ".shp" ? "ESRI Shapefile" : "GPKG", nullptr};
  CPLSetThreadLocalConfigOption("SHAPE_RESTORE_SHX", "YES");
  const GDALDatasetUniquePtr dataset(
      GDALDataset::Open(copy.name(ending).c_str(), GDAL_OF_VECTOR | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR,
                        drivers, nullptr, nullptr));
  CPLSetThreadLocalConfigOption("SHAPE_RESTORE_SHX", nullptr);
  if (!dataset)
    return fail(ErrorCode::kUnreadableData,
                fmt::format("{} is no readable {}: {}", file, ending == ".shp" ? "Shapefile" : "GeoPackage",
                            session.complaints()));
  const auto layer = layer_of(*dataset, property, file);
  if (!layer) return fail(layer.error());
  auto units = read_layer(**layer, property, stated, file);
  if (units) units->format = ending == ".shp" ? "Shapefile" : "GeoPackage";
  return units;
}

std::string geojson_of(const SoilUnits& units, const std::string& property) {
  const auto quoted = [](const std::string& text) {
    CPLJSONObject holder;
    holder.Add("text", text);
    return holder.GetObj("text").Format(CPLJSONObject::PrettyFormat::Plain);
  };
  std::string text = R"({"type":"FeatureCollection","features":[)";
  const char* between = "\n";
  for (const LabelledPolygon& polygon : units.polygons) {
    const std::unique_ptr<char, decltype(&VSIFree)> geometry(polygon.geometry->exportToJson(), &VSIFree);
    if (!geometry) continue;
    text += fmt::format(R"({}{{"type":"Feature","properties":{{{}:{}}},"geometry":{}}})", between,
                        quoted(property), quoted(polygon.label), geometry.get());
    between = ",\n";
  }
  return text + "\n]}\n";
}

Result<ImportedUnits> import_soil_units(const fs::path& source, const std::string& property,
                                        PolygonCoordinates stated, const std::vector<SoilClass>& legend,
                                        const ElevationInfo& ground, const fs::path& out) {
  const std::string file = source.filename().string();
  ImportedUnits imported;
  std::string where, text;
  {
    const GdalSession session(source);
    auto units = read_soil_units(source, property, stated, session);
    if (!units) return fail(std::move(units.error()));
    std::set<std::string> labels;
    for (const LabelledPolygon& polygon : units->polygons) labels.insert(polygon.label);
    imported.labels.assign(labels.begin(), labels.end());
    imported.format = units->format;
    if (legend.empty()) return imported;
    where = where_units_lie(*units, ground);
    if (const auto moved = bring_to_map(*units, ground, file, session); !moved) return fail(moved.error());
    imported.notes = units->notes;
    imported.in_map_metres = units->format != "GeoJSON" || stated == PolygonCoordinates::kMap;
    text = units->format == "GeoJSON" ? "" : geojson_of(*units, property);
  }
  const auto map = read_soil_polygons(source, ground, ground.geometry.extent(), property, stated, legend);
  if (!map) return fail(map.error());
  imported.cover = cover_of(**map, ground.geometry.extent(), "unit");
  if (imported.cover.is_empty) imported.cover.warnings.back() += where;
  std::error_code error;
  if (text.empty()) {
    fs::copy_file(source, out, error);
  } else {
    std::ofstream stream(out, std::ios::binary);
    stream << text;
    stream.close();
    if (!stream) error = std::make_error_code(std::errc::io_error);
  }
  if (error) return fail(ErrorCode::kUnwritableFile, "The soil map could not be written: " + error.message());
  return imported;
}

}  // namespace slipway::dem
