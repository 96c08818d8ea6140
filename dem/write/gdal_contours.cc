#include <cpl_string.h>
#include <fmt/format.h>
#include <gdal_alg.h>
#include <gdal_priv.h>
#include <ogrsf_frmts.h>

#include <array>
#include <limits>
#include <utility>
#include <vector>

#include "dem/gdal_import.h"
#include "dem/gdal_session.h"
#include "dem/write/contours.h"

namespace slipway::dem {
namespace {

constexpr float kNoHeight = std::numeric_limits<float>::lowest();

// Where GDAL puts the lines.
class Lines final : public OGRLayer {
 public:
  Lines() : definition_(new OGRFeatureDefn("contours")) {
    definition_->Reference();
    definition_->SetGeomType(wkbLineString);
    OGRFieldDefn height("height_m", OFTReal);
    definition_->AddFieldDefn(&height);
    taken_.name = "contours";
    taken_.lines = true;
    taken_.fields.push_back({"height_m", false});
  }
  ~Lines() override { definition_->Release(); }

  void ResetReading() override {}
  OGRFeature* GetNextFeature() override { return nullptr; }
  OGRFeatureDefn* GetLayerDefn() override { return definition_; }
  int TestCapability(const char* capability) override { return EQUAL(capability, OLCSequentialWrite); }

  OGRErr ICreateFeature(OGRFeature* feature) override {
    const OGRGeometry* const geometry = feature->GetGeometryRef();
    if (geometry == nullptr || wkbFlatten(geometry->getGeometryType()) != wkbLineString)
      return OGRERR_FAILURE;
    const OGRLineString& line = *geometry->toLineString();
    points_ += line.getNumPoints();
    if (points_ > kMaxContourPoints) return OGRERR_FAILURE;
    const double height = feature->GetFieldAsDouble(0);
    VectorFeature made;
    made.values.emplace_back(height);
    for (int i = 0; i < line.getNumPoints(); ++i) made.points.push_back({line.getX(i), line.getY(i), height});
    taken_.features.push_back(std::move(made));
    return OGRERR_NONE;
  }

  bool too_many() const { return points_ > kMaxContourPoints; }
  VectorLayer take() { return std::move(taken_); }

 private:
  OGRFeatureDefn* definition_;
  VectorLayer taken_;
  long long points_ = 0;
};

// Nothing where there is no memory for it, or it was cancelled.
GDALDatasetUniquePtr raster_of(const Terrain& terrain, const Progress& progress) {
  const GridGeometry& g = terrain.geometry();
  GDALDatasetUniquePtr raster(
      GetGDALDriverManager()->GetDriverByName("MEM")->Create("", g.columns, g.rows, 1, GDT_Float32, nullptr));
  if (!raster) return nullptr;
  std::array<double, 6> transform{g.west_m, g.cell_x_m, 0.0, g.north_m, 0.0, -g.cell_y_m};
  raster->SetGeoTransform(transform.data());
  GDALRasterBand& band = *raster->GetRasterBand(1);
  band.SetNoDataValue(kNoHeight);
  std::vector<float> row(static_cast<std::size_t>(g.columns));
  for (int r = 0; r < g.rows; ++r) {
    if (progress.cancelled()) return nullptr;
    for (int c = 0; c < g.columns; ++c)
      row[static_cast<std::size_t>(c)] = static_cast<float>(terrain.height_m(Cell{r, c}).value_or(kNoHeight));
    if (band.RasterIO(GF_Write, 0, r, g.columns, 1, row.data(), g.columns, 1, GDT_Float32, 0, 0, nullptr) !=
        CE_None)
      return nullptr;
  }
  return raster;
}

}  // namespace

Result<VectorLayer> contours_of(const Terrain& terrain, double every_m, double base_m, Progress& progress) {
  const GdalSession session;
  const GDALDatasetUniquePtr raster = raster_of(terrain, progress);
  if (progress.cancelled()) return fail(ErrorCode::kCancelled, "the map was given up");
  if (!raster) return fail(ErrorCode::kInternal, "The heights could not be held: " + session.complaints());
  CPLStringList options;
  options.AddNameValue("LEVEL_INTERVAL", fmt::format("{}", every_m).c_str());
  options.AddNameValue("LEVEL_BASE", fmt::format("{}", base_m).c_str());
  options.AddNameValue("NODATA", fmt::format("{}", kNoHeight).c_str());
  options.AddNameValue("ELEV_FIELD", "0");
  Lines lines;
  StageProgress told{&progress, "drawing contours"};
  const CPLErr done = GDALContourGenerateEx(GDALRasterBand::ToHandle(raster->GetRasterBand(1)),
                                            OGRLayer::ToHandle(&lines), options.List(), &report_stage, &told);
  if (progress.cancelled()) return fail(ErrorCode::kCancelled, "the map was given up");
  if (lines.too_many())
    return fail(ErrorCode::kInvalidRequest, "There are too many contours.",
                {{"/every", fmt::format("{} m makes more than {} points; take a greater distance between "
                                        "heights or a smaller extent",
                                        every_m, kMaxContourPoints)}});
  if (done != CE_None)
    return fail(ErrorCode::kInternal, "The contours could not be drawn: " + session.complaints());
  return lines.take();
}

}  // namespace slipway::dem
