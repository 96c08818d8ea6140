// GDAL's own reader, as ogrinfo has it, says what is in the files.

#include "dem/vector_file.h"

#include <cpl_vsi.h>
#include <gdal_priv.h>
#include <gtest/gtest.h>
#include <ogrsf_frmts.h>

#include <cmath>

#include "raster_fixture.h"

namespace slipway::dem {
namespace {

std::vector<VectorLayer> layers() {
  return {{"routes",
           true,
           {{"route", false}, {"verdict", true}},
           {{{{8142640.0, -276640.0, -4458.5}, {8142610.0, -276643.0, -4459.0}}, {1.0, std::string("go")}},
            {{{8142640.0, -276640.0, -4458.5}}, {2.0, std::monostate()}}}},
          {"stations", false, {{"slip", false}}, {{{{1.5, 2.5, 3.5}}, {0.125}}}}};
}

const char* mars_wkt() {
  static const std::string wkt = [] {
    test::prepare_gdal();
    OGRSpatialReference crs;
    crs.SetFromUserInput(test::kMarsSphere);
    char* text = nullptr;
    crs.exportToWkt(&text);
    std::string copy(text);
    CPLFree(text);
    return copy;
  }();
  return wkt.c_str();
}

// Opens the bytes with GDAL.
class Opened {
 public:
  explicit Opened(const std::string& bytes) : bytes_(bytes) {
    VSIFCloseL(VSIFileFromMemBuffer("/vsimem/opened.gpkg", reinterpret_cast<GByte*>(bytes_.data()),
                                    bytes_.size(), FALSE));
    file_.reset(GDALDataset::Open("/vsimem/opened.gpkg", GDAL_OF_VECTOR | GDAL_OF_READONLY));
  }
  ~Opened() {
    file_.reset();
    VSIUnlink("/vsimem/opened.gpkg");
  }
  Opened(const Opened&) = delete;
  Opened& operator=(const Opened&) = delete;
  GDALDataset* operator->() { return file_.get(); }
  explicit operator bool() const { return file_ != nullptr; }

 private:
  std::string bytes_;
  GDALDatasetUniquePtr file_;
};

TEST(VectorFile, AGeoPackageHoldsLayersAttributesAndTheBodysSystem) {
  const auto bytes = encode_geopackage(layers(), mars_wkt());
  ASSERT_TRUE(bytes) << bytes.error().detail;
  Opened file(*bytes);
  ASSERT_TRUE(file);
  ASSERT_EQ(file->GetLayerCount(), 2);
  OGRLayer& routes = *file->GetLayerByName("routes");
  EXPECT_EQ(routes.GetFeatureCount(), 2);
  ASSERT_NE(routes.GetSpatialRef(), nullptr);
  EXPECT_EQ(routes.GetSpatialRef()->GetSemiMajor(), 3396190.0);
  EXPECT_TRUE(routes.GetSpatialRef()->IsProjected());
  const OGRFeatureUniquePtr first(routes.GetNextFeature());
  EXPECT_STREQ(first->GetFieldAsString("verdict"), "go");
  EXPECT_NEAR(first->GetGeometryRef()->toLineString()->get_Length(), std::hypot(30.0, 3.0), 1e-9);
  const OGRFeatureUniquePtr second(routes.GetNextFeature());
  EXPECT_EQ(second->GetGeometryRef(), nullptr);
  EXPECT_TRUE(second->IsFieldNull(second->GetFieldIndex("verdict")));
  const OGRFeatureUniquePtr station(file->GetLayerByName("stations")->GetNextFeature());
  EXPECT_EQ(station->GetFieldAsDouble("slip"), 0.125);
  EXPECT_EQ(station->GetGeometryRef()->toPoint()->getZ(), 3.5);
}

TEST(VectorFile, TheSameLayersGiveTheSameBytes) {
  EXPECT_EQ(encode_geopackage(layers(), mars_wkt()).value(), encode_geopackage(layers(), mars_wkt()).value());
}

}  // namespace
}  // namespace slipway::dem
