// Maps as others write them, brought into a terrain's form. GDAL itself reads what came out.

#include "dem/terrain_import.h"

#include <gdal_priv.h>
#include <gtest/gtest.h>
#include <ogr_spatialref.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "dem/gdal_file_fence.h"
#include "dem/gdal_session.h"
#include "raster_fixture.h"

namespace slipway::dem {
namespace {

using test::gdal_value_at;
using test::RasterOptions;
using test::TemporaryFolder;
using test::write_geotiff;

constexpr const char* kMoonPole = "+proj=stere +lat_0=-90 +lon_0=0 +k=1 +R=1737400 +units=m +no_defs";

// Row * 10 + column, so that every cell tells where it was.
std::vector<float> numbered(int rows, int columns) {
  std::vector<float> cells;
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) cells.push_back(static_cast<float>(10 * row + column));
  return cells;
}

class TerrainImport : public testing::Test {
 protected:
  Result<ImportedElevation> imported(const RasterOptions& options, bool fix, const std::string& crs = "") {
    write_geotiff(folder_ / "dem.tif", options);
    std::filesystem::create_directories(folder_ / "made");
    NoProgress quiet;
    return import_elevation({.source = folder_ / "dem.tif", .crs = crs, .fix = fix}, out(), quiet);
  }
  std::filesystem::path out() const { return folder_ / "made" / "elevation.tif"; }
  // The faults' sentences in one text; what is expected to be refused.
  static std::string told(const Result<ImportedElevation>& made) {
    if (made) return "it was imported";
    std::string text = made.error().detail;
    for (const Fault& fault : made.error().faults) text += "\n" + fault.message;
    return text;
  }
  static void expect_parts(const std::string& text, const std::vector<std::string>& parts) {
    for (const std::string& part : parts)
      EXPECT_NE(text.find(part), std::string::npos) << text << " lacks " << part;
  }
  double height_at(double x_m, double y_m) const {
    const auto source = open_elevation(out());
    EXPECT_TRUE(source);
    const auto ground = (*source)->read({x_m - 1.0, y_m - 1.0, x_m + 1.0, y_m + 1.0});
    EXPECT_TRUE(ground) << ground.error().detail;
    return ground ? (*ground)->height_m(x_m, y_m).value_or(NAN) : NAN;
  }

  TemporaryFolder folder_;
};

TEST_F(TerrainImport, AGoodMapKeepsEveryCellInTilesWithOverviews) {
  RasterOptions options{.rows = 600, .columns = 700, .transform = {100.0, 2.0, 0.0, 2000.0, 0.0, -3.0}};
  options.cells = numbered(600, 700);
  options.cells[701] = -9999.0F;
  options.also = [](GDALDataset& raster) { raster.GetRasterBand(1)->SetNoDataValue(-9999.0); };
  const auto made = imported(options, false);
  ASSERT_TRUE(made) << told(made);
  EXPECT_TRUE(made->changes.empty());
  EXPECT_EQ(made->lowest_m, 0.0);
  EXPECT_EQ(made->highest_m, 6689.0);
  EXPECT_NEAR(made->unknown_share, 1.0 / 420000.0, 1e-12);
  test::with_gdal(out(), [](GDALDataset& raster) {
    EXPECT_STREQ(raster.GetMetadataItem("COMPRESSION", "IMAGE_STRUCTURE"), "DEFLATE");
    int width = 0, height = 0;
    raster.GetRasterBand(1)->GetBlockSize(&width, &height);
    EXPECT_EQ(width, 256);
    EXPECT_EQ(height, 256);
    EXPECT_GE(raster.GetRasterBand(1)->GetOverviewCount(), 2);
  });
  EXPECT_EQ(gdal_value_at(out(), 101.0, 1998.5), 0.0);
  EXPECT_EQ(gdal_value_at(out(), 100.0 + 2 * 699.5, 2000.0 - 3 * 599.5), 6689.0);
}

TEST_F(TerrainImport, EverythingThatIsWrongIsToldAtOnceWithItsRemedy) {
  const RasterOptions options{
      .transform = {137.0, 0.001, 0, -4.0, 0, 0.001},
      .crs = "+proj=longlat +R=3396190 +no_defs",
      .cells = numbered(4, 5),
      .also = [](GDALDataset& raster) { raster.GetRasterBand(1)->SetUnitType("ft"); }};
  const auto made = imported(options, false);
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().faults.size(), 3U);
  expect_parts(told(made), {"3 reasons", "--fix mends all of it", "first cell in the south",
                            "pixels in degrees", "gdalwarp -t_srs", "\"ft\"", "--calc='A*0.3048'"});
  EXPECT_FALSE(std::filesystem::exists(out()));
  EXPECT_TRUE(imported(options, true));
}

TEST_F(TerrainImport, ASouthUpMapIsTurnedWithoutANewCell) {
  const RasterOptions options{.transform = {100.0, 2.0, 0.0, 200.0, 0.0, 3.0}, .cells = numbered(4, 5)};
  ASSERT_FALSE(imported(options, false));
  const auto made = imported(options, true);
  ASSERT_TRUE(made) << told(made);
  EXPECT_EQ(made->info.geometry, (GridGeometry{4, 5, 100.0, 212.0, 2.0, 3.0}));
  EXPECT_EQ(gdal_value_at(out(), 105.0, 201.5), 2.0);  // the first row is the southernmost
  EXPECT_EQ(gdal_value_at(out(), 105.0, 210.5), 32.0);
}

TEST_F(TerrainImport, MapCoordinatesThatCountToTheWestAreCountedToTheEast) {
  // Planetographic equirectangular of Mars around the meridian 0: x grows to the west.
  RasterOptions options{.crs = "IAU_2015:49911", .cells = numbered(4, 5)};
  ASSERT_FALSE(imported(options, false));
  const auto made = imported(options, true);
  ASSERT_TRUE(made) << told(made);
  EXPECT_EQ(made->info.geometry, (GridGeometry{4, 5, -110.0, 200.0, 2.0, 3.0}));
  EXPECT_EQ(gdal_value_at(out(), -101.0, 198.5), 0.0);  // the first column is the easternmost
  EXPECT_EQ(gdal_value_at(out(), -109.0, 189.5), 34.0);
  // Around another meridian nobody says which way that one counts.
  options.crs = "EPSG:2046";
  EXPECT_FALSE(imported(options, true));
}

TEST_F(TerrainImport, FeetOfTheGridAndOfTheHeightsBecomeMetres) {
  RasterOptions options{.transform = {6000000.0, 10.0, 0.0, 2100000.0, 0.0, -10.0}, .crs = "EPSG:2227"};
  options.cells = numbered(4, 5);
  options.also = [](GDALDataset& raster) { raster.GetRasterBand(1)->SetUnitType("US survey foot"); };
  const auto made = imported(options, true);
  ASSERT_TRUE(made) << told(made);
  constexpr double kFoot = 1200.0 / 3937.0;
  EXPECT_NEAR(made->info.geometry.cell_x_m, 10.0 * kFoot, 1e-9);
  EXPECT_NEAR(made->info.geometry.west_m, 6000000.0 * kFoot, 1e-4);
  EXPECT_NEAR(made->highest_m, 34.0 * kFoot, 1e-5);
  EXPECT_NEAR(gdal_value_at(out(), (6000000.0 + 25.0) * kFoot, (2100000.0 - 15.0) * kFoot), 12.0 * kFoot,
              1e-5);
}

// A slope in rows and columns: a height tells the place to a tenth of a cell.
RasterOptions slope(const std::array<double, 6>& transform, const std::string& crs) {
  RasterOptions options{.rows = 200, .columns = 200, .transform = transform, .crs = crs};
  for (int row = 0; row < 200; ++row)
    for (int column = 0; column < 200; ++column)
      options.cells.push_back(static_cast<float>(row + 0.5 * column));
  return options;
}

struct Place {
  double x, y;
};

Place on_map(const ElevationInfo& info, double longitude_deg, double latitude_deg) {
  OGRSpatialReference map;
  map.importFromWkt(info.crs_wkt.c_str());
  map.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  const std::unique_ptr<OGRSpatialReference> degrees(map.CloneGeogCS());
  degrees->SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  const std::unique_ptr<OGRCoordinateTransformation> to_map(
      OGRCreateCoordinateTransformation(degrees.get(), &map));
  Place place{longitude_deg, latitude_deg};
  to_map->Transform(1, &place.x, &place.y);
  return place;
}

TEST_F(TerrainImport, DegreesBecomeAConformalMapOfTheGround) {
  // 0.001 deg of latitude on this sphere is 59.27 m, of longitude at 60 deg north half of that.
  const auto made =
      imported(slope({10.0, 0.002, 0.0, 60.1, 0.0, -0.001}, "+proj=longlat +R=3396190 +no_defs"), true);
  ASSERT_TRUE(made) << told(made);
  const Place there = on_map(made->info, 10.0 + 60.5 * 0.002, 60.1 - 100.5 * 0.001);
  EXPECT_NEAR(height_at(there.x, there.y), 130.0, 0.1);
  const Extent extent = made->info.geometry.extent();
  EXPECT_NEAR(extent.north_m - extent.south_m, 0.2 * M_PI / 180.0 * 3396190.0, 200.0);
  EXPECT_NEAR(extent.east_m - extent.west_m, 0.4 * M_PI / 180.0 * 3396190.0 * 0.5, 200.0);
}

TEST_F(TerrainImport, LengthsThatAreNotTheGroundsAreMended) {
  // 3,556,521 m north of the equator of this map is 60 deg: a metre of it eastwards is half a metre there.
  const RasterOptions options = slope({1000000.0, 2.0, 0.0, 3556521.0, 0.0, -1.0}, test::kMarsSphere);
  expect_parts(told(imported(options, false)), {"a metre of the map is", "--fix mends it"});
  const auto made = imported(options, true);
  ASSERT_TRUE(made) << told(made);
  const Extent extent = made->info.geometry.extent();
  EXPECT_NEAR(extent.east_m - extent.west_m, 200.0, 4.0);
  EXPECT_NEAR(extent.north_m - extent.south_m, 200.0, 4.0);
  constexpr double kDegree_m = 3396190.0 * M_PI / 180.0;
  const Place middle = on_map(made->info, 1000200.0 / kDegree_m, 3556421.0 / kDegree_m);
  EXPECT_NEAR(height_at(middle.x, middle.y), 99.5 + 0.5 * 99.5, 0.1);
}

TEST_F(TerrainImport, WestPositiveDegreesAreTurnedTowardsTheEast) {
  // Longitude 223 W to 222.8 W from left to right: 137 E to 137.2 E.
  const auto made = imported(slope({223.0, -0.001, 0.0, -4.0, 0.0, -0.001}, "IAU_2015:49901"), true);
  ASSERT_TRUE(made) << told(made);
  const Place there = on_map(made->info, 137.0 + 60.5 * 0.001, -4.0 - 100.5 * 0.001);
  EXPECT_NEAR(height_at(there.x, there.y), 130.0, 0.1);
}

TEST_F(TerrainImport, ARotatedMapComesToStand) {
  const auto made = imported(slope({0.0, 0.8, 0.6, 0.0, 0.6, -0.8}, kMoonPole), true);
  ASSERT_TRUE(made) << told(made);
  EXPECT_GT(made->unknown_share, 0.2);  // the corners that the turned map does not reach
  EXPECT_NEAR(made->highest_m, 298.5, 1.5);
}

TEST_F(TerrainImport, BlocksThatASparseMapLacksStayUnknownWhenItIsReprojected) {
  RasterOptions options{.rows = 512, .columns = 512, .transform = {137.0, 0.0001, 0.0, -4.0, 0.0, -0.0001}};
  options.crs = "+proj=longlat +R=3396190 +no_defs";
  options.creation = {"TILED=YES", "SPARSE_OK=TRUE"};
  options.also = [](GDALDataset& raster) {
    std::vector<float> high(std::size_t{256} * 512, 500.0F);
    ASSERT_EQ(raster.GetRasterBand(1)->RasterIO(GF_Write, 0, 0, 256, 512, high.data(), 256, 512, GDT_Float32,
                                                0, 0, nullptr),
              CE_None);
  };
  const auto made = imported(options, true);
  ASSERT_TRUE(made) << told(made);
  EXPECT_NEAR(made->unknown_share, 0.5, 0.02);
  EXPECT_NEAR(made->lowest_m, 500.0, 1e-3);
}

TEST_F(TerrainImport, AMapWithoutASystemNeedsOneThatIsStated) {
  const RasterOptions options{.crs = "", .cells = numbered(4, 5)};
  const std::string refused = told(imported(options, true));
  expect_parts(refused, {"no coordinate reference system", "gdal_translate -a_srs"});
  EXPECT_EQ(refused.find("--fix mends"), std::string::npos);
  const auto made = imported(options, false, test::kMarsSphere);
  ASSERT_TRUE(made) << told(made);
  EXPECT_EQ(made->info.body, "Mars");
  expect_parts(told(imported(options, false, "https://example.org/crs.wkt")),
               {"--crs is not a system", "IAU_2015:49910"});
}

TEST_F(TerrainImport, AMapOfHalfAPlanetIsToBeCutFirst) {
  const auto made = imported({.transform = {0.0, 36.0, 0, 60.0, 0, -30.0},
                              .crs = "+proj=longlat +R=3396190 +no_defs",
                              .cells = numbered(4, 5)},
                             true);
  expect_parts(told(made), {"gdal_translate -projwin"});
}

TEST_F(TerrainImport, DamageIsToldWithTheRest) {
  RasterOptions options{.rows = 512, .columns = 512, .transform = {0.0, 1.0, 0.0, 0.0, 0.0, 1.0}};
  options.cells.assign(std::size_t{512} * 512, 3.0F);
  write_geotiff(folder_ / "dem.tif", options);
  std::filesystem::resize_file(folder_ / "dem.tif", 700'000);
  std::filesystem::create_directories(folder_ / "made");
  NoProgress quiet;
  const auto made = import_elevation({.source = folder_ / "dem.tif"}, out(), quiet);
  expect_parts(told(made), {"2 reasons", "first cell in the south", "is damaged: rows"});
  const auto fixed = import_elevation({.source = folder_ / "dem.tif", .fix = true}, out(), quiet);
  expect_parts(told(fixed), {"is damaged: rows"});
}

TEST_F(TerrainImport, AMapOfNothingIsRefused) {
  RasterOptions options;
  options.cells.assign(20, NAN);
  expect_parts(told(imported(options, false)), {"no cell with a height"});
}

TEST_F(TerrainImport, OneFolderAloneCanBeWrittenTo) {
  test::prepare_gdal();
  std::filesystem::create_directories(folder_ / "mine");
  std::filesystem::create_directories(folder_ / "other");
  const auto create = [](const std::filesystem::path& path) {
    return GDALDatasetUniquePtr(GetGDALDriverManager()->GetDriverByName("GTiff")->Create(
               path.c_str(), 4, 4, 1, GDT_Byte, nullptr)) != nullptr;
  };
  const GdalSession session;
  EXPECT_FALSE(create(folder_ / "mine" / "a.tif"));
  {
    const WritingAdmission writing(folder_ / "mine");
    EXPECT_TRUE(create(folder_ / "mine" / "a.tif"));
    EXPECT_FALSE(create(folder_ / "other" / "a.tif"));
    EXPECT_FALSE(create(folder_ / "mine" / ".." / "other" / "a.tif"));
    std::filesystem::create_directory_symlink(folder_ / "other", folder_ / "mine" / "link");
    EXPECT_FALSE(create(folder_ / "mine" / "link" / "a.tif"));
    EXPECT_EQ(VSIUnlink((folder_ / "dem.tif").c_str()), -1);
  }
  EXPECT_FALSE(create(folder_ / "mine" / "b.tif"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "other" / "a.tif"));
}

class SoilImportTest : public TerrainImport {
 protected:
  SoilImportTest() {
    RasterOptions ground{.rows = 40, .columns = 40, .transform = {0.0, 1.0, 0.0, 40.0, 0.0, -1.0}};
    ground.cells = numbered(40, 40);
    info_ = imported(ground, false).value().info;
  }
  Result<ImportedSoil> soil(SoilImport order) {
    NoProgress quiet;
    return import_soil(order, info_, folder_ / "made" / "soil", quiet);
  }

  ElevationInfo info_;
  std::vector<SoilClass> legend_{{1, "sand", "dune"}, {2, "rock", std::nullopt}};
};

TEST_F(SoilImportTest, ClassesInDegreesComeOntoTheElevationsGrid) {
  // 1 m of the equator of this sphere in degrees; the west half is class 1, the east half class 3.
  const double cell = 180.0 / M_PI / 3396190.0;
  RasterOptions classes{
      .rows = 40, .columns = 40, .type = GDT_Byte, .transform = {0.0, cell, 0, 40 * cell, 0, -cell}};
  classes.crs = "+proj=longlat +R=3396190 +no_defs";
  for (int i = 0; i < 1600; ++i) classes.cells.push_back(i % 40 < 20 ? 1.0F : 3.0F);
  write_geotiff(folder_ / "classes.tif", classes);
  const SoilImport order{.source = folder_ / "classes.tif", .legend = legend_};
  const auto refused = soil(order);
  ASSERT_FALSE(refused);
  SoilImport mended = order;
  mended.fix = true;
  const auto made = soil(mended);
  ASSERT_TRUE(made) << made.error().detail;
  EXPECT_EQ(made->unlisted, std::vector<std::string>{"3"});
  const auto map = read_soil_raster(folder_ / "made" / "soil", info_, info_.geometry.extent(), legend_);
  ASSERT_TRUE(map) << map.error().detail;
  EXPECT_EQ((*map)->class_at(19.5, 20.0), 1);
  EXPECT_EQ((*map)->class_at(20.5, 20.0), 3);
}

TEST_F(SoilImportTest, AMapWithoutALegendIsToldItsClasses) {
  RasterOptions classes{
      .rows = 40, .columns = 40, .type = GDT_Byte, .transform = {0.0, 1.0, 0.0, 40.0, 0.0, -1.0}};
  for (int i = 0; i < 1600; ++i) classes.cells.push_back(i % 40 < 20 ? 1.0F : 7.0F);
  write_geotiff(folder_ / "classes.tif", classes);
  const auto made = soil({.source = folder_ / "classes.tif"});
  ASSERT_FALSE(made);
  EXPECT_NE(made.error().faults.at(0).message.find("the map holds 1, 7"), std::string::npos);
}

TEST_F(SoilImportTest, PolygonsAreCopiedAndTheirLabelsCompared) {
  folder_.write("units.geojson",
                R"({"type":"FeatureCollection","features":[{"type":"Feature","properties":{"unit":"sand"},)"
                R"("geometry":{"type":"Polygon","coordinates":[[[0,0],[40,0],[40,40],[0,40],[0,0]]]}},)"
                R"({"type":"Feature","properties":{"unit":"ice"},)"
                R"("geometry":{"type":"Polygon","coordinates":[[[0,0],[4,0],[4,4],[0,4],[0,0]]]}}]})");
  const auto made = soil({.source = folder_ / "units.geojson",
                          .polygons = true,
                          .property = "unit",
                          .coordinates = PolygonCoordinates::kMap,
                          .legend = legend_});
  ASSERT_TRUE(made) << made.error().detail;
  EXPECT_EQ(made->unlisted, std::vector<std::string>{"ice"});
  EXPECT_TRUE(std::filesystem::exists(folder_ / "made" / "soil"));
}

}  // namespace
}  // namespace slipway::dem
