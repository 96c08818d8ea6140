#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cfloat>
#include <cmath>
#include <limits>
#include <thread>

#include "dem/elevation_source.h"
#include "raster_fixture.h"

namespace slipway::dem {
namespace {

using test::RasterOptions;
using test::TemporaryFolder;
using test::write_geotiff;

std::vector<float> ramp_cells(const RasterOptions& options) {
  std::vector<float> cells;
  for (int row = 0; row < options.rows; ++row) {
    for (int column = 0; column < options.columns; ++column) {
      cells.push_back(static_cast<float>(10 * row * row + column));
    }
  }
  return cells;
}

std::shared_ptr<const Terrain> read_all(const std::filesystem::path& path) {
  const auto source = open_elevation(path);
  if (!source) throw std::runtime_error(source.error().detail);
  const auto terrain = (*source)->read((*source)->info().geometry.extent());
  if (!terrain) throw std::runtime_error(terrain.error().detail);
  return *terrain;
}

TEST(Elevation, EveryCellLiesWhereGdalItselfFindsIt) {
  const TemporaryFolder folder;
  for (const char* registration : {"Area", "Point"}) {
    RasterOptions options{.rows = 4, .columns = 5};
    options.cells = ramp_cells(options);
    options.also = [&](GDALDataset& raster) { raster.SetMetadataItem("AREA_OR_POINT", registration); };
    write_geotiff(folder / "grid.tif", options);
    const auto terrain = read_all(folder / "grid.tif");
    for (int i = 0; i < 20; ++i) {
      for (int j = 0; j < 24; ++j) {
        const double x = 100.25 + 0.5 * i;
        const double y = 188.25 + 0.5 * j;
        const auto cell = terrain->geometry().cell_at(x, y);
        ASSERT_TRUE(cell);
        ASSERT_EQ(terrain->height_m(*cell), test::gdal_value_at(folder / "grid.tif", x, y)) << x << " " << y;
      }
    }
  }
}

// Cells of three by three: each has the height of the raster's cell in its middle, whatever the window.
TEST(Elevation, SamplesAreTheSameWhateverTheWindowAndTheMissingStayMissing) {
  const TemporaryFolder folder;
  RasterOptions options{.rows = 20, .columns = 25};
  options.cells = ramp_cells(options);
  // Of row 1, column 4, which is a sample, and of row 0, column 14, which is none.
  options.also = [](GDALDataset& raster) { raster.GetRasterBand(1)->SetNoDataValue(14.0); };
  write_geotiff(folder / "grid.tif", options);
  const auto source = open_elevation(folder / "grid.tif").value();
  const GridGeometry& whole = source->info().geometry;
  const auto fine = source->read(whole.extent()).value();
  const auto samples = source->read_samples(whole.extent(), 3).value();
  EXPECT_EQ(samples->geometry().rows, 7);
  EXPECT_EQ(samples->geometry().columns, 9);
  int missing = 0;
  for (int row = 0; row < 7; ++row) {
    for (int column = 0; column < 9; ++column) {
      const Cell middle{std::min(3 * row + 1, 19), std::min(3 * column + 1, 24)};
      ASSERT_EQ(samples->height_m({row, column}), fine->height_m(middle)) << row << " " << column;
      missing += fine->height_m(middle) ? 0 : 1;
      if (middle == Cell{3 * row + 1, 3 * column + 1}) {
        EXPECT_EQ(samples->geometry().centre_m({row, column}), whole.centre_m(middle));
      }
    }
  }
  EXPECT_EQ(missing, 1);
  const Eigen::Vector2d place = whole.centre_m({10, 13});
  const auto window =
      source->read_samples({place.x(), place.y(), place.x() + 1.0, place.y() + 1.0}, 3).value();
  EXPECT_LT(window->geometry().columns, 9);
  EXPECT_EQ(window->height_m(place.x(), place.y()), samples->height_m(place.x(), place.y()));
  EXPECT_EQ(source->read_samples({0.0, 0.0, 1.0, 1.0}, 3).error().code, ErrorCode::kOffMap);
}

// Reading every row of a large raster for a few samples would take seconds.
TEST(Elevation, SamplesAreCellsOfTheOverviewsWhereTheFileHasThem) {
  const TemporaryFolder folder;
  RasterOptions options{.rows = 64, .columns = 72};
  options.cells = ramp_cells(options);
  options.overviews = {2, 4};
  write_geotiff(folder / "grid.tif", options);
  const auto source = open_elevation(folder / "grid.tif").value();
  const GridGeometry& whole = source->info().geometry;
  const auto fine = source->read(whole.extent()).value();
  const auto samples = source->read_samples(whole.extent(), 7).value();
  EXPECT_EQ(samples->geometry().cell_x_m, 4.0 * whole.cell_x_m) << "the coarsest that is no coarser than 7";
  EXPECT_EQ(samples->geometry().rows, 16);
  EXPECT_EQ(samples->geometry().columns, 18);
  double sum = 0.0;
  for (int row = 8; row < 12; ++row)
    for (int column = 20; column < 24; ++column) sum += *fine->height_m({row, column});
  EXPECT_NEAR(*samples->height_m({2, 5}), sum / 16.0, 1e-4);
  const Eigen::Vector2d place = whole.centre_m({33, 41});
  const auto window =
      source->read_samples({place.x(), place.y(), place.x() + 1.0, place.y() + 1.0}, 7).value();
  EXPECT_LT(window->geometry().columns, 18);
  EXPECT_EQ(window->height_m(place.x(), place.y()), samples->height_m(place.x(), place.y()));
}

TEST(Elevation, ItsInfoNamesTheSystemTheBodyAndTheType) {
  const TemporaryFolder folder;
  write_geotiff(folder / "mars.tif", {});
  write_geotiff(folder / "moon.tif", {.crs = "IAU_2015:30130"});
  write_geotiff(folder / "earth.tif", {.crs = "EPSG:32630"});
  write_geotiff(folder / "vesta.tif", {.crs = "+proj=eqc +R=255000 +units=m"});
  const auto info = [&](const char* name) { return open_elevation(folder / name).value()->info(); };
  EXPECT_EQ(info("mars.tif").body, "Mars");
  EXPECT_EQ(info("mars.tif").semi_major_axis_m, 3396190.0);
  EXPECT_EQ(info("mars.tif").data_type, "Float32");
  EXPECT_EQ(info("moon.tif").body, "Moon");
  EXPECT_EQ(info("earth.tif").body, "Earth");
  EXPECT_EQ(info("earth.tif").crs_name, "WGS 84 / UTM zone 30N");
  EXPECT_EQ(info("vesta.tif").body, "other");
}

TEST(Elevation, HeightsOfAScaledIntegerRasterAreScaleTimesStoredPlusOffset) {
  const TemporaryFolder folder;
  RasterOptions options{.rows = 2, .columns = 3, .type = GDT_Int16, .cells = {0, 10, -10, 100, -32768, 7}};
  options.also = [](GDALDataset& raster) {
    raster.GetRasterBand(1)->SetScale(0.5);
    raster.GetRasterBand(1)->SetOffset(-4000.0);
    raster.GetRasterBand(1)->SetNoDataValue(-32768.0);
  };
  write_geotiff(folder / "scaled.tif", options);
  EXPECT_TRUE(open_elevation(folder / "scaled.tif").value()->info().scaled);
  const auto terrain = read_all(folder / "scaled.tif");
  EXPECT_EQ(terrain->height_m(Cell{0, 1}), -3995.0);
  EXPECT_EQ(terrain->height_m(Cell{1, 0}), -3950.0);
  EXPECT_FALSE(terrain->has_data({1, 1}));  // nodata is compared before scaling
}

TEST(Elevation, MissingCellsAreMaskedHoweverTheFileWritesThem) {
  const TemporaryFolder folder;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float inf = std::numeric_limits<float>::infinity();
  const struct {
    float stored;
    std::optional<double> nodata;
  } cases[] = {{-32767.0F, -32767.0},   {-9999.9F, -9999.9},      {-FLT_MAX, -FLT_MAX},
               {-FLT_MAX, -3.40282e38}, {-FLT_MAX, std::nullopt}, {nan, std::nullopt},
               {nan, std::nan("")},     {inf, std::nullopt},      {-inf, -1.0}};
  for (const auto& [stored, nodata] : cases) {
    RasterOptions options{.rows = 2, .columns = 2, .cells = {1.0F, stored, 0.0F, -5.0F}};
    options.also = [nodata = nodata](GDALDataset& raster) {
      if (nodata) raster.GetRasterBand(1)->SetNoDataValue(*nodata);
    };
    write_geotiff(folder / "gaps.tif", options);
    const auto terrain = read_all(folder / "gaps.tif");
    EXPECT_FALSE(terrain->has_data({0, 1})) << stored;
    EXPECT_EQ(terrain->height_m(Cell{0, 0}), 1.0) << stored;
    EXPECT_EQ(terrain->height_m(Cell{1, 0}), 0.0) << stored;
    EXPECT_EQ(terrain->height_m(Cell{1, 1}), -5.0) << stored;
  }
}

TEST(Elevation, TheMaskOfTheDatasetMasksToo) {
  const TemporaryFolder folder;
  RasterOptions options{.rows = 2, .columns = 2, .cells = {1, 2, 3, 4}};
  options.also = [](GDALDataset& raster) {
    CPLSetThreadLocalConfigOption("GDAL_TIFF_INTERNAL_MASK", "YES");
    raster.GetRasterBand(1)->CreateMaskBand(GMF_PER_DATASET);
    std::uint8_t mask[] = {255, 255, 0, 255};
    ASSERT_EQ(raster.GetRasterBand(1)->GetMaskBand()->RasterIO(GF_Write, 0, 0, 2, 2, mask, 2, 2, GDT_Byte, 0,
                                                               0, nullptr),
              CE_None);
  };
  write_geotiff(folder / "mask.tif", options);
  const auto terrain = read_all(folder / "mask.tif");
  EXPECT_FALSE(terrain->has_data({1, 0}));
  EXPECT_EQ(terrain->height_m(Cell{1, 1}), 4.0);
}

TEST(Elevation, InsideItsExtentAWindowHasTheHeightsAndNormalsOfTheWhole) {
  const TemporaryFolder folder;
  RasterOptions options{
      .rows = 60, .columns = 50, .creation = {"TILED=YES", "BLOCKXSIZE=16", "BLOCKYSIZE=16"}};
  for (int i = 0; i < 3000; ++i) options.cells.push_back(static_cast<float>(std::sin(0.1 * i * i)));
  write_geotiff(folder / "whole.tif", options);
  const auto whole = read_all(folder / "whole.tif");
  const auto source = open_elevation(folder / "whole.tif").value();
  for (const Extent& extent : {Extent{131.0, 71.3, 151.7, 110.2}, Extent{100.0, 150.0, 103.0, 200.0},
                               Extent{190.0, 20.0, 200.0, 26.0}, Extent{150.0, 100.0, 150.0, 100.0}}) {
    const auto window = source->read(extent).value();
    EXPECT_LT(window->geometry().rows * window->geometry().columns, 1000);
    for (int i = 0; i <= 10; ++i) {
      for (int j = 0; j <= 10; ++j) {
        const double x = std::lerp(extent.west_m, extent.east_m, 0.1 * i);
        const double y = std::lerp(extent.south_m, extent.north_m, 0.1 * j);
        const auto expected = whole->surface(x, y);
        const auto got = window->surface(x, y);
        ASSERT_TRUE(expected && got);
        ASSERT_NEAR(got->height_m, expected->height_m, 1e-9);
        ASSERT_NEAR((got->normal - expected->normal).norm(), 0.0, 1e-9);
      }
    }
  }
}

TEST(Elevation, AnExtentBesideTheRasterIsOffTheMap) {
  const TemporaryFolder folder;
  write_geotiff(folder / "grid.tif", {});
  const auto terrain = open_elevation(folder / "grid.tif").value()->read({500.0, 500.0, 600.0, 600.0});
  ASSERT_FALSE(terrain);
  EXPECT_EQ(terrain.error().code, ErrorCode::kOffMap);
}

TEST(Elevation, ManyThreadsMayReadOneSource) {
  const TemporaryFolder folder;
  RasterOptions options{.rows = 300, .columns = 300, .creation = {"TILED=YES", "COMPRESS=DEFLATE"}};
  options.cells = ramp_cells(options);
  write_geotiff(folder / "grid.tif", options);
  const auto source = open_elevation(folder / "grid.tif").value();
  const std::string fingerprint = source->read(source->info().geometry.extent()).value()->fingerprint();
  std::array<int, 4> same{};
  {
    std::vector<std::jthread> threads;
    threads.reserve(same.size());
    for (int& count : same) {
      threads.emplace_back([&] {
        for (int k = 0; k < 10; ++k) {
          const auto terrain = source->read(source->info().geometry.extent());
          count += terrain && (*terrain)->fingerprint() == fingerprint ? 1 : 0;
        }
      });
    }
  }
  EXPECT_EQ(same, (std::array<int, 4>{10, 10, 10, 10}));
}

// 16,384 x 16,384 cells, a gigabyte if it were written; only the tiles around row and column 8,000 are.
class LargeElevation : public testing::Test {
 protected:
  LargeElevation() {
    RasterOptions options{.rows = 16384, .columns = 16384, .transform = {0.0, 1.0, 0.0, 16384.0, 0.0, -1.0}};
    options.creation = {"TILED=YES", "SPARSE_OK=TRUE"};
    options.also = [](GDALDataset& raster) {
      raster.GetRasterBand(1)->SetNoDataValue(-32767.0);
      std::vector<float> heights(std::size_t{512} * 512);
      for (std::size_t i = 0; i < heights.size(); ++i) heights[i] = static_cast<float>(i % 512);
      ASSERT_EQ(raster.GetRasterBand(1)->RasterIO(GF_Write, 7936, 7936, 512, 512, heights.data(), 512, 512,
                                                  GDT_Float32, 0, 0, nullptr),
                CE_None);
    };
    write_geotiff(folder_ / "large.tif", options);
  }

  TemporaryFolder folder_;
};

// A raster in two by two tiles, of which one was written; it declares no value for missing cells.
TEST(Elevation, BlocksThatASparseFileDoesNotHoldAreUnknown) {
  const TemporaryFolder folder;
  RasterOptions options{.rows = 64, .columns = 64, .transform = {0.0, 1.0, 0.0, 64.0, 0.0, -1.0}};
  options.creation = {"SPARSE_OK=YES", "TILED=YES", "BLOCKXSIZE=32", "BLOCKYSIZE=32"};
  options.also = [](GDALDataset& raster) {
    std::vector<float> heights(32 * 32, 7.0F);
    ASSERT_EQ(raster.GetRasterBand(1)->RasterIO(GF_Write, 32, 32, 32, 32, heights.data(), 32, 32, GDT_Float32,
                                                0, 0, nullptr),
              CE_None);
  };
  write_geotiff(folder / "sparse.tif", options);
  const auto terrain = open_elevation(folder / "sparse.tif").value()->read({0.0, 0.0, 64.0, 64.0}).value();
  EXPECT_FALSE(terrain->height_m(Cell{10, 10}));
  EXPECT_FALSE(terrain->height_m(Cell{31, 32}));
  EXPECT_FALSE(terrain->height_m(Cell{32, 31}));
  EXPECT_EQ(terrain->height_m(Cell{32, 32}), 7.0);
  EXPECT_EQ(terrain->height_m(Cell{63, 63}), 7.0);
}

// Of a raster of 100 m cells about a place in a projection.
Result<std::shared_ptr<const Terrain>> read_about(const TemporaryFolder& folder, const std::string& crs,
                                                  double x, double y) {
  write_geotiff(folder / "far.tif", {.transform = {x - 250.0, 100.0, 0.0, y + 200.0, 0.0, -100.0},
                                     .crs = crs,
                                     .cells = std::vector<float>(20, 1.0F)});
  return open_elevation(folder / "far.tif").value()->read({x - 200.0, y - 100.0, x + 200.0, y + 100.0});
}

TEST(Elevation, WhereAMapsLengthsAreNotTheGroundsItIsRefusedWithTheCommand) {
  const TemporaryFolder folder;
  constexpr double kMetresPerDegree = 59274.697;  // of the Mars sphere
  const auto far = read_about(folder, test::kMarsSphere, 0.0, 60.0 * kMetresPerDegree);
  ASSERT_FALSE(far);
  EXPECT_EQ(far.error().code, ErrorCode::kUnsupportedCrs);
  for (const char* part :
       {"0.500 to 1.000 m of the ground", "gdalwarp -t_srs '+proj=stere +lat_0=60 +lon_0=0"})
    EXPECT_NE(far.error().detail.find(part), std::string::npos) << far.error().detail;
  EXPECT_TRUE(read_about(folder, test::kMarsSphere, 0.0, -4.6 * kMetresPerDegree));
  EXPECT_TRUE(read_about(folder, "+proj=eqc +lat_ts=60 +lat_0=0 +lon_0=0 +R=3396190 +units=m", 0.0,
                         60.0 * kMetresPerDegree));
  const std::string polar_moon = "+proj=stere +lat_0=-90 +lat_ts=-90 +lon_0=0 +R=1737400 +units=m";
  EXPECT_TRUE(read_about(folder, polar_moon, 0.0, 0.0)) << "the pole itself";
  EXPECT_TRUE(read_about(folder, polar_moon, 100000.0, -100000.0));
  EXPECT_FALSE(read_about(folder, polar_moon, 700000.0, -700000.0)) << "57 degrees south";
}

// The most memory that this process has had.
long peak_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss / 1024;
}

TEST_F(LargeElevation, AWindowReadsJustTheWindow) {
  const long before = peak_mb();
  const auto source = open_elevation(folder_ / "large.tif").value();
  const auto terrain = source->read({8000.0, 8084.0, 8300.0, 8384.0}).value();
  EXPECT_EQ(terrain->geometry().rows, 304);
  EXPECT_EQ(terrain->geometry().columns, 304);
  EXPECT_EQ(terrain->height_m(8000.5, 8083.5), 64.0);
  EXPECT_LT(peak_mb() - before, 50);  // the whole raster would take 1,024 MB and more
}

TEST_F(LargeElevation, OfTheWholeOnlyWhatIsLookedAtIsRead) {
  const auto source = open_elevation(folder_ / "large.tif").value();
  const long before = peak_mb();
  const auto terrain = source->read(source->info().geometry.extent());
  ASSERT_TRUE(terrain) << terrain.error().detail;
  const Extent extent = (*terrain)->geometry().extent();
  const double x = 0.5 * (extent.west_m + extent.east_m), y = 0.5 * (extent.south_m + extent.north_m);
  const auto window = source->read({x - 10.0, y - 10.0, x + 10.0, y + 10.0}).value();
  EXPECT_EQ((*terrain)->height_m(x + 1.3, y - 2.7), window->height_m(x + 1.3, y - 2.7));
  EXPECT_LT(peak_mb() - before, 50);
}

TEST_F(LargeElevation, WhereNothingWasWrittenEverythingIsMasked) {
  const auto terrain = open_elevation(folder_ / "large.tif").value()->read({10.0, 10.0, 20.0, 20.0}).value();
  EXPECT_FALSE(terrain->height_m(15.0, 15.0));
}

}  // namespace
}  // namespace slipway::dem
