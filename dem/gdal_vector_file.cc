#include <cpl_conv.h>
#include <fmt/format.h>
#include <gdal_priv.h>
#include <ogrsf_frmts.h>

#include <algorithm>
#include <memory>
#include <mutex>
#include <optional>

#include "dem/gdal_memory_file.h"
#include "dem/gdal_session.h"
#include "dem/vector_file.h"

namespace slipway::dem {
namespace {

// GeoPackages carry the time of their last change, which would make the bytes of every answer its own.
class FixedDate {
 public:
  FixedDate() { CPLSetThreadLocalConfigOption("OGR_CURRENT_DATE", "2000-01-01T00:00:00.000Z"); }
  ~FixedDate() { CPLSetThreadLocalConfigOption("OGR_CURRENT_DATE", nullptr); }
  FixedDate(const FixedDate&) = delete;
  FixedDate& operator=(const FixedDate&) = delete;
};

std::unique_ptr<OGRGeometry> geometry_of(const VectorLayer& layer, const VectorFeature& feature) {
  if (!layer.lines) {
    const auto& [x, y, z] = feature.points.at(0);
    return std::make_unique<OGRPoint>(x, y, z);
  }
  if (feature.points.size() < 2) return nullptr;
  auto line = std::make_unique<OGRLineString>();
  for (const auto& [x, y, z] : feature.points) line->addPoint(x, y, z);
  return line;
}

bool write_feature(OGRLayer& out, const VectorLayer& layer, const VectorFeature& feature) {
  OGRFeature made(out.GetLayerDefn());
  for (std::size_t i = 0; i < layer.fields.size(); ++i) {
    const VectorValue& value = feature.values.at(i);
    const int field = static_cast<int>(i);
    if (const auto* const number = std::get_if<double>(&value)) made.SetField(field, *number);
    if (const auto* const text = std::get_if<std::string>(&value)) made.SetField(field, text->c_str());
    if (std::holds_alternative<std::monostate>(value)) made.SetFieldNull(field);
  }
  if (auto geometry = geometry_of(layer, feature)) made.SetGeometryDirectly(geometry.release());
  return out.CreateFeature(&made) == OGRERR_NONE;
}

// Where it ends early, `why` says so, or else GDAL does.
bool write_features(OGRLayer& out, const VectorLayer& layer, std::optional<Error>& why) {
  for (const VectorFeature& feature : layer.features)
    if (!write_feature(out, layer, feature)) return false;
  while (layer.more) {
    const auto some = layer.more();
    if (!some) why = some.error();
    if (!some || some->empty()) return some.has_value();
    for (const VectorFeature& feature : *some)
      if (!write_feature(out, layer, feature)) return false;
  }
  return true;
}

bool write_layer(GDALDataset& file, const VectorLayer& layer, OGRSpatialReference* crs,
                 std::optional<Error>& why) {
  OGRLayer* const out =
      file.CreateLayer(layer.name.c_str(), crs, layer.lines ? wkbLineString25D : wkbPoint25D, nullptr);
  if (out == nullptr) return false;
  for (const VectorField& field : layer.fields) {
    OGRFieldDefn definition(field.name.c_str(), field.is_text ? OFTString : OFTReal);
    if (out->CreateField(&definition) != OGRERR_NONE) return false;
  }
  return write_features(*out, layer, why);
}

// The table from which QGIS takes styles. Its columns are QGIS's own.
bool write_styles(GDALDataset& file, const std::vector<VectorLayer>& layers) {
  OGRLayer* const table = file.CreateLayer("layer_styles", nullptr, wkbNone, nullptr);
  if (table == nullptr) return false;
  constexpr const char* kTexts[] = {"f_table_catalog", "f_table_schema", "f_table_name", "f_geometry_column",
                                    "styleName",       "styleQML",       "styleSLD"};
  for (const char* const name : kTexts) {
    OGRFieldDefn field(name, OFTString);
    if (table->CreateField(&field) != OGRERR_NONE) return false;
  }
  OGRFieldDefn used("useAsDefault", OFTInteger);
  used.SetSubType(OFSTBoolean);
  if (table->CreateField(&used) != OGRERR_NONE) return false;
  for (const char* const name : {"description", "owner", "ui"}) {
    OGRFieldDefn field(name, OFTString);
    if (table->CreateField(&field) != OGRERR_NONE) return false;
  }
  OGRFieldDefn time("update_time", OFTDateTime);
  if (table->CreateField(&time) != OGRERR_NONE) return false;
  for (const VectorLayer& layer : layers) {
    if (layer.style_qml.empty()) continue;
    OGRFeature row(table->GetLayerDefn());
    row.SetField("f_table_catalog", "");
    row.SetField("f_table_schema", "");
    row.SetField("f_table_name", layer.name.c_str());
    row.SetField("f_geometry_column", "geom");
    row.SetField("styleName", layer.name.c_str());
    row.SetField("styleQML", layer.style_qml.c_str());
    row.SetField("styleSLD", "");
    row.SetField("useAsDefault", 1);
    row.SetField("description", "slipway");
    row.SetField("owner", "");
    row.SetField("update_time", 2000, 1, 1, 0, 0, 0.0F, 100);
    if (table->CreateFeature(&row) != OGRERR_NONE) return false;
  }
  return true;
}

bool write_layers(GDALDataset& file, const std::vector<VectorLayer>& layers, OGRSpatialReference* crs,
                  std::optional<Error>& why) {
  if (file.StartTransaction() != OGRERR_NONE) return false;
  for (const VectorLayer& layer : layers)
    if (!write_layer(file, layer, crs, why)) return false;
  const bool styled = std::any_of(layers.begin(), layers.end(),
                                  [](const VectorLayer& layer) { return !layer.style_qml.empty(); });
  if (styled && !write_styles(file, layers)) return false;
  return file.CommitTransaction() == OGRERR_NONE;
}

void register_geopackage() {
  static std::once_flag once;
  std::call_once(once, &RegisterOGRGeoPackage);
}

// Where the session admits the file.
Result<void> write_file(const GdalSession& session, const std::string& path,
                        const std::vector<VectorLayer>& layers, const std::string& crs_wkt) {
  register_geopackage();
  const FixedDate date;
  std::unique_ptr<OGRSpatialReference> crs;
  if (!crs_wkt.empty()) {
    crs = std::make_unique<OGRSpatialReference>();
    if (crs->importFromWkt(crs_wkt.c_str()) != OGRERR_NONE) crs.reset();
  }
  GDALDatasetUniquePtr file(
      GetGDALDriverManager()->GetDriverByName("GPKG")->Create(path.c_str(), 0, 0, 0, GDT_Unknown, nullptr));
  std::optional<Error> why;
  const bool complete = file && write_layers(*file, layers, crs.get(), why);
  CPLErrorReset();
  file.reset();  // closing writes what is left
  if (why) return fail(*std::move(why));
  if (complete && CPLGetLastErrorType() < CE_Failure) return {};
  return fail(ErrorCode::kInternal,
              fmt::format("The GeoPackage could not be encoded: {}", session.complaints()));
}

}  // namespace

Result<void> write_geopackage(const std::string& path, const std::vector<VectorLayer>& layers,
                              const std::string& crs_wkt) {
  return write_file(GdalSession(path), path, layers, crs_wkt);
}

Result<std::string> encode_geopackage(const std::vector<VectorLayer>& layers, const std::string& crs_wkt) {
  GdalMemoryFile memory(".gpkg");
  const auto written = write_file(GdalSession(), memory.name(), layers, crs_wkt);
  auto bytes = memory.take();
  if (!written) return fail(written.error());
  if (!bytes) return fail(ErrorCode::kInternal, "The GeoPackage has no bytes.");
  return *std::move(bytes);
}

}  // namespace slipway::dem
