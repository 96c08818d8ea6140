#include <gtest/gtest.h>

#include <fstream>

#include "dem/elevation_source.h"
#include "raster_fixture.h"

namespace slipway::dem {
namespace {

using test::RasterOptions;
using test::TemporaryFolder;
using test::write_geotiff;

class ElevationRefusal : public testing::Test {
 protected:
  // The error of opening a raster that was written so.
  Error refusal_of(const RasterOptions& options) {
    write_geotiff(folder_ / "dem.tif", options);
    return refusal_of(folder_ / "dem.tif");
  }
  static Error refusal_of(const std::filesystem::path& path) {
    const auto source = open_elevation(path);
    if (source) {
      ADD_FAILURE() << path << " was opened";
      return {};
    }
    return source.error();
  }

  TemporaryFolder folder_;
};

void expect_refusal(const Error& error, ErrorCode code, const std::vector<std::string>& parts) {
  EXPECT_EQ(error.code, code) << error.detail;
  for (const std::string& part : parts) {
    EXPECT_NE(error.detail.find(part), std::string::npos) << error.detail << " lacks: " << part;
  }
}

TEST_F(ElevationRefusal, DegreePixelsAreRefusedWithAProjectionOnTheRastersOwnSphere) {
  expect_refusal(
      refusal_of({.transform = {137.0, 0.1, 0, -4.0, 0, -0.1}, .crs = "+proj=longlat +R=3396190 +no_defs"}),
      ErrorCode::kUnsupportedCrs,
      {"degrees",
       "gdalwarp -t_srs '+proj=eqc +lat_ts=-4.2 +lat_0=0 +lon_0=137.25 +R=3396190 +units=m +no_defs' "
       "-r bilinear dem.tif dem_m.tif"});
}

TEST_F(ElevationRefusal, ATextWithFewerBytesThanCellsIsNotSearchedForThem) {
  std::ofstream(folder_ / "dem.asc")
      << "ncols 100000\nnrows 100000\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2 3\n";
  expect_refusal(refusal_of(folder_ / "dem.asc"), ErrorCode::kUnreadableRaster,
                 {"dem.asc", "100000 rows of 100000 numbers", "cut off"});
}

TEST_F(ElevationRefusal, DegreePixelsOnAnEllipsoidAreGivenAProjectionOnThatEllipsoid) {
  expect_refusal(refusal_of({.transform = {-4.0, 0.1, 0, 37.0, 0, -0.1}, .crs = "EPSG:4326"}),
                 ErrorCode::kUnsupportedCrs,
                 {"+proj=tmerc +lat_0=36.8 +lon_0=-3.75", "+a=6378137 +b=6356752.3142"});
}

TEST_F(ElevationRefusal, AWestPositiveSystemIsRefusedAlthoughTheFileHasForgottenItsAxis) {
  expect_refusal(refusal_of({.crs = "IAU_2015:49911"}), ErrorCode::kUnsupportedCrs,
                 {"west-positive", "gdalwarp -t_srs", "gdal_translate -a_srs"});
}

TEST_F(ElevationRefusal, AWestPositiveAxisThatTheFileKeepsIsRefused) {
  expect_refusal(refusal_of({.crs = "EPSG:2046"}), ErrorCode::kUnsupportedCrs, {"west-positive"});
}

TEST_F(ElevationRefusal, FeetAreRefusedWithTheSameProjectionInMetres) {
  const Error error = refusal_of({.crs = "EPSG:2227"});
  expect_refusal(error, ErrorCode::kUnsupportedCrs, {"foot", "gdalwarp -t_srs '+proj=lcc", "+units=m"});
  EXPECT_EQ(error.detail.find("+units=us-ft"), std::string::npos);
}

TEST_F(ElevationRefusal, HeightsInFeetAreRefusedThoughTheGridIsInMetres) {
  expect_refusal(
      refusal_of({.also = [](GDALDataset& raster) { raster.GetRasterBand(1)->SetUnitType("ft"); }}),
      ErrorCode::kUnreadableRaster, {"\"ft\"", "gdal_calc.py"});
}

TEST_F(ElevationRefusal, ARasterWithoutASystemIsRefused) {
  expect_refusal(refusal_of({.crs = ""}), ErrorCode::kUnsupportedCrs,
                 {"no coordinate reference system", "-a_srs"});
}

TEST_F(ElevationRefusal, ARotatedGridIsRefused) {
  expect_refusal(refusal_of({.transform = {100.0, 2.0, 0.1, 200.0, 0.1, -3.0}}), ErrorCode::kUnreadableRaster,
                 {"rotated", "gdalwarp -r bilinear dem.tif dem_m.tif"});
}

TEST_F(ElevationRefusal, ASouthUpGridIsRefused) {
  expect_refusal(refusal_of({.transform = {100.0, 2.0, 0.0, 200.0, 0.0, 3.0}}), ErrorCode::kUnreadableRaster,
                 {"first cell in the south", "gdalwarp"});
}

TEST_F(ElevationRefusal, AGridWithoutAPlaceIsRefused) {
  expect_refusal(refusal_of({.has_transform = false}), ErrorCode::kUnreadableRaster, {"-a_ullr"});
}

TEST_F(ElevationRefusal, TwoBandsAreRefused) {
  expect_refusal(refusal_of({.bands = 2}), ErrorCode::kUnreadableRaster, {"2 bands", "gdal_translate -b 1"});
}

TEST_F(ElevationRefusal, ComplexNumbersAreRefused) {
  expect_refusal(refusal_of({.type = GDT_CFloat32}), ErrorCode::kUnreadableRaster,
                 {"complex", "-ot Float32"});
}

TEST_F(ElevationRefusal, ASingleRowIsRefused) {
  expect_refusal(refusal_of({.rows = 1}), ErrorCode::kUnreadableRaster, {"1 rows"});
}

TEST_F(ElevationRefusal, EverythingThatIsWrongIsReportedTogether) {
  const Error error = refusal_of({.bands = 3, .transform = {100.0, 2.0, 0.0, 200.0, 0.0, 3.0}, .crs = ""});
  expect_refusal(error, ErrorCode::kUnreadableRaster, {"3 bands", "south", "no coordinate reference system"});
  EXPECT_EQ(error.faults.size(), 3U);
}

TEST_F(ElevationRefusal, AStripOfMoreThan256MegabytesIsRefusedBeforeItIsRead) {
  // A few hundred bytes on disk.
  expect_refusal(refusal_of({.rows = 20000,
                             .columns = 20000,
                             .creation = {"SPARSE_OK=TRUE", "COMPRESS=DEFLATE", "BLOCKYSIZE=20000"}}),
                 ErrorCode::kUnreadableRaster, {"blocks of 20000 x 20000 cells", "-co TILED=YES"});
}

TEST_F(ElevationRefusal, ATruncatedFileNamesTheWindowThatIsLostAndKeepsTheRest) {
  RasterOptions options{.rows = 512, .columns = 512, .transform = {0.0, 1.0, 0.0, 512.0, 0.0, -1.0}};
  options.creation = {"TILED=YES"};
  options.cells.assign(std::size_t{512} * 512, 3.0F);
  const std::filesystem::path path = folder_ / "dem.tif";
  write_geotiff(path, options);
  std::filesystem::resize_file(path, std::filesystem::file_size(path) - 300'000);
  const auto source = open_elevation(path).value();
  const auto kept = source->read({10.0, 400.0, 100.0, 500.0});
  ASSERT_TRUE(kept);
  EXPECT_EQ((*kept)->height_m(50.0, 450.0), 3.0);
  const auto lost = source->read({400.0, 10.0, 500.0, 100.0});
  ASSERT_FALSE(lost);
  expect_refusal(lost.error(), ErrorCode::kUnreadableRaster,
                 {"damaged", "rows 410 to 503, columns 398 to 501"});
  EXPECT_TRUE(source->read({10.0, 400.0, 100.0, 500.0}));
}

TEST_F(ElevationRefusal, AFileThatEndsInItsHeaderIsRefused) {
  write_geotiff(folder_ / "dem.tif", {});
  std::filesystem::resize_file(folder_ / "dem.tif", 20);
  EXPECT_EQ(refusal_of(folder_ / "dem.tif").code, ErrorCode::kUnreadableRaster);
}

TEST_F(ElevationRefusal, AVirtualRasterOverAGoodOneIsRefused) {
  write_geotiff(folder_ / "dem.tif", {});
  const auto path = folder_.write(
      "dem.vrt",
      "<VRTDataset rasterXSize=\"5\" rasterYSize=\"4\"><VRTRasterBand dataType=\"Float32\" "
      "band=\"1\"><SimpleSource>"
      "<SourceFilename "
      "relativeToVRT=\"1\">dem.tif</SourceFilename></SimpleSource></VRTRasterBand></VRTDataset>");
  EXPECT_EQ(refusal_of(path).code, ErrorCode::kUnreadableRaster);
}

TEST_F(ElevationRefusal, AFileThatIsNoRasterIsRefusedWithTheReason) {
  expect_refusal(refusal_of(folder_ / "nothing.tif"), ErrorCode::kUnreadableRaster, {"does not exist"});
  expect_refusal(refusal_of(folder_ / ""), ErrorCode::kUnreadableRaster, {"not a regular file"});
  expect_refusal(refusal_of(folder_.write("text.tif", "no raster at all\n")), ErrorCode::kUnreadableRaster,
                 {"not a readable raster"});
  expect_refusal(refusal_of(folder_.write("empty.tif", "")), ErrorCode::kUnreadableRaster,
                 {"not a readable raster"});
  expect_refusal(refusal_of("/vsicurl/http://127.0.0.1:9/dem.tif"), ErrorCode::kUnreadableRaster,
                 {"does not exist"});
  expect_refusal(refusal_of("GTIFF_DIR:1:dem.tif"), ErrorCode::kUnreadableRaster, {"does not exist"});
}

TEST_F(ElevationRefusal, AHeaderCannotSendTheReaderToAFileInAnotherFolder) {
  const TemporaryFolder elsewhere;
  elsewhere.write("secret.img", std::string(80, '\1'));
  const auto label = [&](const std::filesystem::path& data) {
    return "PDS_VERSION_ID = PDS3\r\nRECORD_TYPE = FIXED_LENGTH\r\nRECORD_BYTES = 20\r\n^IMAGE = \"" +
           data.string() +
           "\"\r\nOBJECT = IMAGE\r\nLINES = 4\r\nLINE_SAMPLES = 5\r\nSAMPLE_TYPE = PC_REAL\r\nSAMPLE_BITS = "
           "32\r\n"
           "BANDS = 1\r\nEND_OBJECT = IMAGE\r\nEND\r\n";
  };
  // The same label opens where the data are beside it (and is then refused for its missing grid only).
  folder_.write("here.img", std::string(80, '\1'));
  expect_refusal(refusal_of(folder_.write("here.lbl", label("here.img"))), ErrorCode::kUnreadableRaster,
                 {"no coordinate reference system"});
  expect_refusal(
      refusal_of(folder_.write("there.lbl", label(std::filesystem::path("..") /
                                                  (elsewhere / "").parent_path().filename() / "secret.img"))),
      ErrorCode::kUnreadableRaster, {"not a readable raster"});
}

}  // namespace
}  // namespace slipway::dem
