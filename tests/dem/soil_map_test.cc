#include "dem/soil_map.h"

#include <gtest/gtest.h>

#include "raster_fixture.h"

namespace slipway::dem {
namespace {

using test::RasterOptions;
using test::TemporaryFolder;
using test::write_geotiff;

const std::vector<SoilClass> kLegend{
    {1, "A", "sand"}, {2, "B", std::nullopt}, {3, "C", "rock"}, {4, "D", "sand"}};

TEST(SoilMap, GapsOfTheLegendAreUnknownGround) {
  const SoilMap map({.rows = 1, .columns = 6, .north_m = 1.0}, {1, 2, 3, 4, 9, 1}, {1, 1, 1, 1, 1, 0},
                    kLegend);
  EXPECT_EQ(map.soils(), (std::vector<std::string>{"sand", "rock"}));
  EXPECT_EQ(map.soil_at(0.5, 0.5), 0U);
  EXPECT_FALSE(map.soil_at(1.5, 0.5));  // a class without a soil
  EXPECT_EQ(map.class_at(1.5, 0.5), 2);
  EXPECT_EQ(map.soil_at(2.5, 0.5), 1U);
  EXPECT_EQ(map.soil_at(3.5, 0.5), 0U);
  EXPECT_FALSE(map.soil_at(4.5, 0.5));  // a class that the legend does not know
  EXPECT_EQ(map.class_at(4.5, 0.5), 9);
  EXPECT_FALSE(map.class_at(5.5, 0.5));  // a cell without a class
  EXPECT_FALSE(map.soil_at(6.5, 0.5));   // off the map
  EXPECT_DOUBLE_EQ(map.unknown_fraction(), 0.5);
}

TEST(SoilMap, TheClassIsTheNearestCellsAndNeverInterpolated) {
  const SoilMap map({.rows = 1, .columns = 2, .north_m = 1.0}, {1, 3}, {1, 1}, kLegend);
  EXPECT_EQ(map.class_at(0.999, 0.1), 1);
  EXPECT_EQ(map.class_at(1.001, 0.1), 3);
}

class SoilRaster : public testing::Test {
 protected:
  SoilRaster() {
    write_geotiff(folder_ / "dem.tif", {.rows = 8, .columns = 10, .transform = {100, 1, 0, 200, 0, -1}});
  }
  ElevationInfo ground() const { return open_elevation(folder_ / "dem.tif").value()->info(); }
  Result<std::shared_ptr<const SoilMap>> read(const RasterOptions& options,
                                              const std::vector<SoilClass>& legend = kLegend) const {
    write_geotiff(folder_ / "classes.tif", options);
    return read_soil_raster(folder_ / "classes.tif", ground(), ground().geometry.extent(), legend);
  }

  TemporaryFolder folder_;
};

// As gdalwarp -dstalpha and GIS tools write it: where nothing is to be seen there is no class.
TEST_F(SoilRaster, ABandOfOpacityHidesCells) {
  RasterOptions options{
      .rows = 8, .columns = 10, .bands = 2, .type = GDT_Byte, .transform = {100, 1, 0, 200, 0, -1}};
  options.cells.assign(80, 3.0F);
  options.also = [](GDALDataset& dataset) {
    GDALRasterBand& alpha = *dataset.GetRasterBand(2);
    alpha.SetColorInterpretation(GCI_AlphaBand);
    std::vector<std::uint8_t> opacity(80, 255);
    for (std::size_t i = 0; i < 40; ++i) opacity[i] = 0;
    EXPECT_EQ(alpha.RasterIO(GF_Write, 0, 0, 10, 8, opacity.data(), 10, 8, GDT_Byte, 0, 0, nullptr), CE_None);
  };
  const auto map = read(options);
  ASSERT_TRUE(map) << map.error().detail;
  EXPECT_FALSE((*map)->class_at(105.5, 199.5));
  EXPECT_EQ((*map)->class_at(105.5, 192.5), 3);
  EXPECT_EQ((*map)->cells_of_rows(), (std::vector<std::size_t>{0, 0, 40, 0}));
}

// 354.47 deg and -5.53 deg are one place: the elevation may have either, and the classes the other.
TEST_F(SoilRaster, ClassesWholeTurnsOfLongitudeAwayLieOnTheMap) {
  const double turn = 2.0 * 3.14159265358979323846 * 3396190.0;
  for (const double of_map : {0.0, 1.0, -1.0, 2.0}) {
    for (const double of_classes : {0.0, 1.0, -1.0}) {
      write_geotiff(folder_ / "dem.tif",
                    {.rows = 8, .columns = 10, .transform = {100 + of_map * turn, 1, 0, 200, 0, -1}});
      RasterOptions options{.rows = 8,
                            .columns = 10,
                            .type = GDT_Byte,
                            .transform = {100 + of_classes * turn, 1, 0, 200, 0, -1}};
      for (int i = 0; i < 80; ++i) options.cells.push_back(i % 10 < 5 ? 1.0F : 3.0F);
      const auto map = read(options);
      ASSERT_TRUE(map) << map.error().detail;
      EXPECT_EQ((*map)->class_at(104.5 + of_map * turn, 195.5), 1);
      EXPECT_EQ((*map)->class_at(105.5 + of_map * turn, 195.5), 3);
    }
  }
}

TEST_F(SoilRaster, ThinnedItHasTheClassOfOnePlaceForEachStep) {
  // 8 x 10 cells of 1 m like the elevation's: the west half sand, the east half rock.
  RasterOptions options{.rows = 8, .columns = 10, .type = GDT_Byte, .transform = {100, 1, 0, 200, 0, -1}};
  for (int i = 0; i < 80; ++i) options.cells.push_back(i % 10 < 5 ? 1.0F : 3.0F);
  write_geotiff(folder_ / "classes.tif", options);
  const Extent all = ground().geometry.extent();
  const auto map = read_soil_raster(folder_ / "classes.tif", ground(), all, kLegend, 3);
  ASSERT_TRUE(map) << map.error().detail;
  EXPECT_EQ((*map)->geometry().rows, 3);
  EXPECT_EQ((*map)->geometry().columns, 4);
  EXPECT_DOUBLE_EQ((*map)->geometry().extent().east_m, all.east_m);
  EXPECT_DOUBLE_EQ((*map)->geometry().extent().south_m, all.south_m);
  EXPECT_EQ((*map)->class_at(101.0, 199.0), 1);
  EXPECT_EQ((*map)->class_at(109.0, 193.0), 3);
  // Cells five times as large as the elevation's are not thinned by three of these.
  RasterOptions coarse{.rows = 2, .columns = 2, .type = GDT_Byte, .transform = {100, 5, 0, 200, 0, -4}};
  coarse.cells = {1, 3, 2, 4};
  write_geotiff(folder_ / "coarse.tif", coarse);
  EXPECT_EQ(read_soil_raster(folder_ / "coarse.tif", ground(), all, kLegend, 3).value()->geometry().rows, 2);
}

TEST_F(SoilRaster, ItsGridNeedNotBeTheElevationsAndNodataHasNoClass) {
  RasterOptions options{.rows = 2, .columns = 2, .type = GDT_Byte, .transform = {100, 5, 0, 200, 0, -4}};
  options.cells = {1, 3, 255, 2};
  options.also = [](GDALDataset& raster) { raster.GetRasterBand(1)->SetNoDataValue(255); };
  const auto map = read(options);
  ASSERT_TRUE(map) << map.error().detail;
  EXPECT_EQ((*map)->class_at(101.0, 199.0), 1);
  EXPECT_EQ((*map)->class_at(109.0, 199.0), 3);
  EXPECT_FALSE((*map)->class_at(101.0, 193.0));
  EXPECT_DOUBLE_EQ((*map)->unknown_fraction(), 0.5);
}

TEST_F(SoilRaster, AnotherSystemThanTheElevationsIsRefused) {
  const auto map = read({.type = GDT_Byte, .crs = "+proj=eqc +lat_ts=0 +lon_0=1 +R=3396190 +units=m"});
  ASSERT_FALSE(map);
  EXPECT_EQ(map.error().code, ErrorCode::kUnsupportedCrs);
  EXPECT_NE(map.error().detail.find("gdalwarp -t_srs"), std::string::npos);
}

TEST_F(SoilRaster, TheSameSystemUnderAnotherNameIsAccepted) {
  EXPECT_TRUE(
      read({.type = GDT_Byte,
            .transform = {100, 1, 0, 200, 0, -1},
            .crs = "PROJCS[\"my Mars\",GEOGCS[\"my sphere\",DATUM[\"my datum\",SPHEROID[\"ball\",3396190,0]],"
                   "PRIMEM[\"Reference_Meridian\",0],UNIT[\"degree\",0.0174532925199433]],"
                   "PROJECTION[\"Equirectangular\"],UNIT[\"metre\",1]]"}));
}

TEST_F(SoilRaster, FractionsAreNoClasses) {
  const auto map = read({.type = GDT_Float32});
  ASSERT_FALSE(map);
  EXPECT_NE(map.error().detail.find("whole numbers"), std::string::npos);
}

TEST_F(SoilRaster, AClassBeyond16BitsIsRefusedNotClamped) {
  const auto map = read({.rows = 2,
                         .columns = 2,
                         .type = GDT_Int32,
                         .transform = {100, 1, 0, 200, 0, -1},
                         .cells = {1, 2, 3, 40000}});
  ASSERT_FALSE(map);
  EXPECT_NE(map.error().detail.find("class = 40000, must be in [-32768, 32767]"), std::string::npos);
}

TEST_F(SoilRaster, ALegendThatRepeatsAValueIsAFault) {
  const auto map = read({.type = GDT_Byte}, {{1, "A", "sand"}, {1, "B", "rock"}});
  ASSERT_FALSE(map);
  EXPECT_EQ(map.error().faults.at(0).pointer, "/legend/1/value");
}

}  // namespace
}  // namespace slipway::dem
