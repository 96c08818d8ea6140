// What the numbers of a map mean, in the many ways in which files say it.

#include <gdal_priv.h>
#include <gtest/gtest.h>
#include <ogr_spatialref.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "dem/body_degrees.h"
#include "dem/terrain_import.h"
#include "raster_fixture.h"

namespace slipway::dem {
namespace {

using test::RasterOptions;
using test::TemporaryFolder;
using test::write_geotiff;

constexpr double kSurveyFoot_m = 1200.0 / 3937.0;

class RasterMeaning : public testing::Test {
 protected:
  Result<ImportedElevation> imported(ElevationImport order = {}) {
    if (order.source.empty()) order.source = folder_ / "dem.tif";
    order.fix = true;
    std::error_code ignored;
    std::filesystem::remove_all(folder_ / "made", ignored);
    std::filesystem::create_directories(folder_ / "made");
    NoProgress quiet;
    return import_elevation(order, folder_ / "made" / "elevation.tif", quiet);
  }
  Result<ImportedElevation> imported(const RasterOptions& options, ElevationImport order = {}) {
    write_geotiff(folder_ / "dem.tif", options);
    return imported(std::move(order));
  }
  static std::string told(const Result<ImportedElevation>& made) {
    std::string text;
    if (made) {
      text = made->reading;
      for (const auto* list : {&made->changes, &made->on_trust, &made->warnings})
        for (const std::string& line : *list) text += "\n" + line;
      return text;
    }
    text = made.error().detail;
    for (const Fault& fault : made.error().faults) text += "\n" + fault.message;
    return text;
  }
  static void expect_parts(const std::string& text, const std::vector<std::string>& parts) {
    for (const std::string& part : parts)
      EXPECT_NE(text.find(part), std::string::npos) << text << " lacks " << part;
  }
  // A sidecar as GDAL, QGIS and rasterio write it.
  void write_sidecar(const std::string& of_band) const {
    folder_.write("dem.tif.aux.xml",
                  "<PAMDataset><PAMRasterBand band=\"1\">" + of_band + "</PAMRasterBand></PAMDataset>");
  }

  TemporaryFolder folder_;
};

// One height in every cell, in a map of 20 x 20 cells.
RasterOptions plain(float height, const std::string& crs = test::kMarsSphere) {
  RasterOptions options{
      .rows = 20, .columns = 20, .transform = {100.0, 1.0, 0.0, 200.0, 0.0, -1.0}, .crs = crs};
  for (int i = 0; i < 400; ++i) options.cells.push_back(height + static_cast<float>(i));
  return options;
}

// New Mexico Central in survey feet: a rise of 5 % to the east, in cells of 6 feet.
RasterOptions feet(const std::string& crs) {
  RasterOptions options{
      .rows = 40, .columns = 50, .transform = {1640000.0, 6.0, 0.0, 1700000.0, 0.0, -6.0}, .crs = crs};
  for (int row = 0; row < 40; ++row)
    for (int column = 0; column < 50; ++column)
      options.cells.push_back(7000.0F + 0.3F * static_cast<float>(column));
  return options;
}

std::string bound(const std::string& crs) {
  OGRSpatialReference system;
  system.SetFromUserInput(crs.c_str());
  system.SetTOWGS84(1.0, 2.0, 3.0);
  char* text = nullptr;
  const char* const options[] = {"FORMAT=WKT2_2019", nullptr};
  system.exportToWkt(&text, options);
  const std::string wkt = text;
  CPLFree(text);
  return wkt;
}

TEST_F(RasterMeaning, FeetOfACompoundSystemAreThoseOfItsHorizontalPart) {
  test::prepare_gdal();
  for (const std::string& crs : {std::string("EPSG:6529+6360"), std::string("EPSG:6529+5703"),
                                 std::string("EPSG:6529"), bound("EPSG:6529")}) {
    // The horizontal part counts whether the file or --crs names the system.
    for (const bool stated : {false, true}) {
      const auto made = imported(feet(stated ? test::kMarsSphere : crs), {.crs = stated ? crs : ""});
      ASSERT_TRUE(made) << crs << told(made);
      EXPECT_NEAR(made->info.geometry.cell_x_m, 6.0 * kSurveyFoot_m, 1e-6) << crs;
      EXPECT_NEAR(made->info.geometry.cell_y_m, 6.0 * kSurveyFoot_m, 1e-6) << crs;
      EXPECT_NEAR(made->info.geometry.west_m, 1640000.0 * kSurveyFoot_m, 1e-3) << crs;
      const Extent extent = made->info.geometry.extent();
      const auto corner =
          BodyDegrees(made->info.crs_wkt, made->info.body).to_degrees({extent.west_m, extent.north_m});
      ASSERT_TRUE(corner);
      EXPECT_NEAR(corner->x, -106.25140, 1e-4) << crs;
      EXPECT_NEAR(corner->y, 35.67234, 1e-4) << crs;
      const bool feet_high = crs.find("6360") != std::string::npos;
      EXPECT_NEAR(made->lowest_m, 7000.0 * (feet_high ? kSurveyFoot_m : 1.0), 1e-3) << crs << told(made);
    }
  }
}

TEST_F(RasterMeaning, HeightsAreNotShiftedToAnotherVerticalDatum) {
  RasterOptions degrees = plain(341.0F, "EPSG:4326+5773");
  degrees.transform = {9.0, 0.0001, 0.0, 46.95, 0.0, -0.0001};
  const auto made = imported(degrees);
  ASSERT_TRUE(made) << told(made);
  EXPECT_NEAR(made->lowest_m, 341.0, 3.0);
  EXPECT_NEAR(made->highest_m, 740.0, 6.0);
  expect_parts(made->reading, {"vertical datum EGM96 height (not shifted)"});
  RasterOptions rotated = plain(341.0F, "EPSG:32632+5773");
  rotated.transform = {500000.0, 1.9, 0.6, 5200000.0, 0.6, -1.9};
  const auto turned = imported(rotated);
  ASSERT_TRUE(turned) << told(turned);
  EXPECT_NEAR(turned->lowest_m, 341.0, 3.0);
}

TEST_F(RasterMeaning, TransparentCellsHaveNoHeightWhateverTheTypeOfTheAlphaBand) {
  for (const GDALDataType type : {GDT_Byte, GDT_UInt16, GDT_Int16, GDT_Float32, GDT_Float64}) {
    for (const int bands : {2, 3}) {
      RasterOptions options = plain(50.0F);
      options.bands = bands;
      options.type = type == GDT_Byte ? GDT_UInt16 : type;
      options.also = [bands](GDALDataset& raster) {
        raster.GetRasterBand(1)->SetDescription("elevation");
        GDALRasterBand& alpha = *raster.GetRasterBand(bands);
        alpha.SetColorInterpretation(GCI_AlphaBand);
        std::vector<float> opacity(400, 0.0F);
        std::fill(opacity.begin() + 100, opacity.end(), 1.0F);
        ASSERT_EQ(alpha.RasterIO(GF_Write, 0, 0, 20, 20, opacity.data(), 20, 20, GDT_Float32, 0, 0, nullptr),
                  CE_None);
      };
      const auto made = imported(options);
      ASSERT_TRUE(made) << GDALGetDataTypeName(type) << told(made);
      EXPECT_NEAR(made->unknown_share, 0.25, 1e-9) << GDALGetDataTypeName(type) << bands;
      EXPECT_EQ(made->lowest_m, 150.0);
      if (bands == 2) {
        const auto opened = open_elevation(folder_ / "dem.tif");
        ASSERT_TRUE(opened) << opened.error().detail;
        const auto ground = (*opened)->read({100.0, 180.0, 120.0, 200.0}).value();
        EXPECT_FALSE(ground->height_m(Cell{4, 4}));
        EXPECT_EQ(ground->height_m(Cell{5, 0}), 150.0);
      }
    }
  }
}

TEST_F(RasterMeaning, AMaskBesideTheFileCounts) {
  RasterOptions mask{.rows = 20, .columns = 20, .type = GDT_Byte, .has_transform = false, .crs = ""};
  mask.cells.assign(400, 255.0F);
  std::fill(mask.cells.begin(), mask.cells.begin() + 40, 0.0F);
  mask.also = [](GDALDataset& raster) { raster.SetMetadataItem("INTERNAL_MASK_FLAGS_1", "2"); };
  write_geotiff(folder_ / "dem.tif.msk", mask);
  const auto made = imported(plain(50.0F));
  ASSERT_TRUE(made) << told(made);
  EXPECT_NEAR(made->unknown_share, 0.1, 1e-9);
  EXPECT_EQ(made->lowest_m, 90.0);
}

TEST_F(RasterMeaning, WhatASidecarSaysCountsAndIsNamed) {
  write_sidecar("<Offset>10</Offset><Scale>0.5</Scale><UnitType>m</UnitType>");
  auto made = imported(plain(100.0F));
  ASSERT_TRUE(made) << told(made);
  EXPECT_NEAR(made->lowest_m, 60.0, 1e-9);
  expect_parts(made->reading,
               {"scale 0.5 and offset 10 from dem.tif.aux.xml", "metres from dem.tif.aux.xml"});
  write_sidecar("<NoDataValue>100</NoDataValue>");
  made = imported(plain(100.0F));
  ASSERT_TRUE(made) << told(made);
  EXPECT_NEAR(made->lowest_m, 101.0, 1e-9);
  expect_parts(made->reading, {"nodata 100 from dem.tif.aux.xml"});
  write_sidecar("<UnitType>ft</UnitType>");
  made = imported(plain(100.0F));
  ASSERT_TRUE(made) << told(made);
  EXPECT_NEAR(made->lowest_m, 30.48, 1e-4);
  // The same of a file that a terrain names itself.
  const auto opened = open_elevation(folder_ / "dem.tif");
  ASSERT_FALSE(opened);
  expect_parts(opened.error().detail, {"\"ft\""});
}

TEST_F(RasterMeaning, AProjectionWithoutATrueScaleIsRefused) {
  const auto mercator = [](double scale) {
    return "PROJCS[\"Mercator "
           "MARS\",GEOGCS[\"GCS_MARS\",DATUM[\"D_MARS\",SPHEROID[\"MARS\",3396190,169.894447223612]],"
           "PRIMEM[\"Reference_Meridian\",0],UNIT[\"degree\",0.0174532925199433]],PROJECTION[\"Mercator_"
           "1SP\"],"
           "PARAMETER[\"latitude_of_origin\",0],PARAMETER[\"central_meridian\",0],PARAMETER[\"scale_"
           "factor\"," +
           std::to_string(scale) +
           "],PARAMETER[\"false_easting\",0],PARAMETER[\"false_northing\",0],UNIT[\"metre\",1]]";
  };
  const auto map = [&](double scale) {
    RasterOptions options{
        .rows = 60, .columns = 60, .transform = {1000000.0, 100.0, 0.0, 3900000.0, 0.0, -100.0}};
    options.crs = mercator(scale);
    for (int i = 0; i < 3600; ++i) options.cells.push_back(-1800.0F + 10.0F * static_cast<float>(i % 60));
    return options;
  };
  for (const double scale : {0.0, 5.0}) {
    const auto refused = imported(map(scale));
    ASSERT_FALSE(refused) << scale;
    expect_parts(told(refused), {"scale factor of", "no length of the map is that of the ground", "--crs",
                                 "gdal_translate -a_srs"});
    EXPECT_FALSE(open_elevation(folder_ / "dem.tif"));
  }
  // At 55 degrees north a metre of this map is 0.57 m of the ground: a rise of 10 % is one of 17 %.
  const auto made = imported(map(1.0));
  ASSERT_TRUE(made) << told(made);
  const auto ground =
      open_elevation(folder_ / "made" / "elevation.tif").value()->read(made->info.geometry.extent()).value();
  const GridGeometry& grid = made->info.geometry;
  const double west = ground->height_m(Cell{grid.rows / 2, 10}).value();
  const double east = ground->height_m(Cell{grid.rows / 2, 50}).value();
  EXPECT_NEAR(std::atan((east - west) / (40.0 * grid.cell_x_m)) * 180.0 / M_PI, 9.87, 0.05);
}

TEST_F(RasterMeaning, PicturesAreNoHeights) {
  RasterOptions grey = plain(0.0F);
  grey.type = GDT_Byte;
  expect_parts(told(imported(grey)), {"numbers of 8 bits without a unit", "--unit m"});
  const auto stated = imported(grey, {.unit = "m"});
  ASSERT_TRUE(stated) << told(stated);
  expect_parts(told(stated), {"steps of 1 m"});
  RasterOptions palette = grey;
  palette.also = [](GDALDataset& raster) {
    GDALColorTable colours;
    const GDALColorEntry red{255, 0, 0, 255};
    colours.SetColorEntry(0, &red);
    raster.GetRasterBand(1)->SetColorTable(&colours);
  };
  expect_parts(told(imported(palette)), {"palette"});
  EXPECT_FALSE(imported(palette, {.unit = "m"}));
  RasterOptions colours = grey;
  colours.bands = 3;
  colours.creation = {"PHOTOMETRIC=RGB"};
  expect_parts(told(imported(colours)), {"holds colours", "Terrarium", "gdal_calc.py"});
}

TEST_F(RasterMeaning, ASidecarThatCannotBeReadIsNotPassedOver) {
  folder_.write("dem.tif.aux.xml", "<PAMDataset><PAMRasterBand");
  expect_parts(told(imported(plain(100.0F))),
               {"dem.tif.aux.xml lies beside the map and can't be read", "mv dem.tif.aux.xml"});
  EXPECT_FALSE(open_elevation(folder_ / "dem.tif"));
}

TEST_F(RasterMeaning, ColoursOfSixteenBitsAreNoHeightsEither) {
  RasterOptions colours = plain(100.0F);
  colours.type = GDT_UInt16;
  colours.bands = 3;
  colours.creation = {"PHOTOMETRIC=RGB"};
  expect_parts(told(imported(colours)), {"it is a picture, not heights", "choose it with --band"});
  EXPECT_TRUE(imported(colours, {.band = 1}));
}

TEST_F(RasterMeaning, AProjectionThatDoesNotReachTheMapIsRefused) {
  for (const char* crs : {"+proj=eqc +lat_ts=90 +lon_0=0 +R=3396190 +units=m +no_defs",
                          "+proj=ortho +lat_0=0 +lon_0=0 +R=3396190 +units=m +no_defs"}) {
    RasterOptions options = plain(100.0F, crs);
    options.transform = {9000000.0, 1.0, 0.0, 200.0, 0.0, -1.0};
    expect_parts(told(imported(options)), {"in which the middle of the map", "--crs"});
  }
}

TEST_F(RasterMeaning, AFrameWithoutDegreesIsExplained) {
  const std::string refused = told(imported(
      plain(100.0F,
            "LOCAL_CS[\"Mars (2015) / Ocentric\",LOCAL_DATUM[\"none\",0],UNIT[\"metre\",1],AXIS[\"x\",EAST],"
            "AXIS[\"y\",NORTH]]")));
  expect_parts(refused, {"neither a projection nor degrees", "--crs '+proj=longlat +R=3396190 +no_defs'"});
}

TEST_F(RasterMeaning, TheBandOfHeightsIsTakenOrAskedFor) {
  RasterOptions options = plain(1.0F);
  options.bands = 2;
  const auto second = [](GDALDataset& raster) {
    std::vector<float> high(400, 700.0F);
    ASSERT_EQ(raster.GetRasterBand(2)->RasterIO(GF_Write, 0, 0, 20, 20, high.data(), 20, 20, GDT_Float32, 0,
                                                0, nullptr),
              CE_None);
  };
  options.also = second;
  expect_parts(told(imported(options)), {"2 bands", "--band"});
  auto made = imported(options, {.band = 2});
  ASSERT_TRUE(made) << told(made);
  EXPECT_EQ(made->highest_m, 700.0);
  expect_parts(told(imported(options, {.band = 3})), {"no band 3", "1, 2"});
  options.also = [&](GDALDataset& raster) {
    second(raster);
    raster.GetRasterBand(1)->SetDescription("vertical precision");
    raster.GetRasterBand(2)->SetDescription("elevation");
  };
  made = imported(options);
  ASSERT_TRUE(made) << told(made);
  EXPECT_EQ(made->highest_m, 700.0);
  expect_parts(told(made), {"band 2 \"elevation\" (by its description)"});
  made = imported(options, {.band = 1});
  ASSERT_TRUE(made) << told(made);
  expect_parts(told(made), {"described as \"vertical precision\", which is no height"});
}

TEST_F(RasterMeaning, GroundAtZeroIsGround) {
  RasterOptions options = plain(0.0F);
  options.rows = options.columns = 600;
  options.cells.assign(360'000, 0.0F);
  auto made = imported(options);
  ASSERT_TRUE(made) << told(made);
  EXPECT_EQ(made->unknown_share, 0.0);
  EXPECT_TRUE(made->warnings.empty()) << told(made);
  // As a file system keeps it where zeros are holes.
  const auto file = folder_ / "dem.tif";
  const auto size = std::filesystem::file_size(file);
  std::string bytes(static_cast<std::size_t>(size), '\0');
  std::ifstream(file, std::ios::binary).read(bytes.data(), static_cast<std::streamsize>(size));
  std::filesystem::remove(file);
  std::ofstream holed(file, std::ios::binary);
  std::size_t first = bytes.find_last_not_of('\0') + 1;  // the header may be at either end
  const std::size_t zeros = bytes.find(std::string(100'000, '\0'));
  first = zeros == std::string::npos ? first : zeros;
  holed.write(bytes.data(), static_cast<std::streamsize>(first));
  const std::size_t after = bytes.find_first_not_of('\0', first);
  if (after != std::string::npos) {
    holed.seekp(static_cast<std::streamoff>(after));
    holed.write(bytes.data() + after, static_cast<std::streamsize>(bytes.size() - after));
  }
  holed.close();
  std::filesystem::resize_file(file, size);
  made = imported();
  ASSERT_TRUE(made) << told(made);
  EXPECT_EQ(made->unknown_share, 0.0);
}

TEST_F(RasterMeaning, FillsAndCollarsThatNobodyDeclaresAreToldWithTheirPlace) {
  RasterOptions options = plain(-4500.0F);
  for (int i = 0; i < 400; ++i) {
    const int row = i / 20, column = i % 20;
    options.cells[static_cast<std::size_t>(i)] =
        row < 2 || column < 2
            ? 0.0F
            : -4500.0F + 0.1F * static_cast<float>(row) + 0.07F * static_cast<float>(column);
  }
  auto made = imported(options);
  ASSERT_TRUE(made) << told(made);
  ASSERT_EQ(made->warnings.size(), 1U) << told(made);
  expect_parts(made->warnings.front(), {"76 cells, 19.0 % of all with a height", "the one height 0 m",
                                        "a cliff of up to 449", "row ", "column ", "--nodata"});
  made = imported(options, {.nodata = 0.0});
  ASSERT_TRUE(made) << told(made);
  EXPECT_TRUE(made->warnings.empty()) << told(made);
  EXPECT_NEAR(made->unknown_share, 0.19, 1e-9);
  // A fill without a cliff that is a large part of the map.
  RasterOptions lake = plain(0.0F);
  for (int i = 0; i < 400; ++i)
    lake.cells[static_cast<std::size_t>(i)] = i < 100 ? 3.0F : 3.0F + 0.01F * static_cast<float>(i);
  made = imported(lake);
  ASSERT_TRUE(made) << told(made);
  ASSERT_EQ(made->warnings.size(), 1U) << told(made);
  expect_parts(made->warnings.front(), {"100 cells, 25.0 %", "the one height 3 m"});
  // A slope of whole metres has no fill.
  RasterOptions slope = plain(0.0F);
  for (int i = 0; i < 400; ++i) slope.cells[static_cast<std::size_t>(i)] = static_cast<float>(i / 20);
  made = imported(slope);
  ASSERT_TRUE(made) << told(made);
  EXPECT_TRUE(made->warnings.empty()) << told(made);
}

TEST_F(RasterMeaning, TerracesOfRoundedHeightsAreNoCliffs) {
  // Whole metres on cells of a tenth of one: every terrace ends at a wall.
  RasterOptions options = plain(0.0F);
  options.type = GDT_Int16;
  options.transform = {100.0, 0.1, 0.0, 200.0, 0.0, -0.1};
  for (int i = 0; i < 400; ++i) options.cells[static_cast<std::size_t>(i)] = static_cast<float>(i / 60);
  const auto made = imported(options);
  ASSERT_TRUE(made) << told(made);
  EXPECT_TRUE(made->warnings.empty()) << told(made);
}

// An ISIS cube of 4 x 5 cells of 100 m around a meridian.
std::string cube(const std::string& meridian_deg, const std::string& direction) {
  std::string text =
      "Object = IsisCube\n  Object = Core\n    StartByte = 4097\n    Format = BandSequential\n"
      "    Group = Dimensions\n      Samples = 5\n      Lines = 4\n      Bands = 1\n    End_Group\n"
      "    Group = Pixels\n      Type = Real\n      ByteOrder = Lsb\n      Base = 0.0\n      Multiplier = "
      "1.0\n"
      "    End_Group\n  End_Object\n  Group = Mapping\n    ProjectionName = SimpleCylindrical\n"
      "    CenterLongitude = " +
      meridian_deg +
      " <degrees>\n    CenterLatitude = 0.0 <degrees>\n    TargetName = Mars\n"
      "    EquatorialRadius = 3396190.0 <meters>\n    PolarRadius = 3396190.0 <meters>\n"
      "    LatitudeType = Planetocentric\n    LongitudeDirection = " +
      direction +
      "\n    LongitudeDomain = 360\n    UpperLeftCornerX = -250.0 <meters>\n"
      "    UpperLeftCornerY = 200.0 <meters>\n    PixelResolution = 100.0 <meters/pixel>\n  End_Group\n"
      "End_Object\nObject = Label\n  Bytes = 4096\nEnd_Object\nEnd\n";
  text.resize(4096, '\0');
  for (int i = 0; i < 20; ++i) {
    const auto height = static_cast<float>(1000 + i);
    text.append(reinterpret_cast<const char*>(&height), sizeof height);
  }
  return text;
}

TEST_F(RasterMeaning, ALabelThatCountsLongitudesToTheWestIsHeeded) {
  for (const auto& [meridian, direction] :
       {std::pair{"137.5", "PositiveEast"}, {"222.5", "PositiveWest"}, {"-137.5", "PositiveWest"}}) {
    folder_.write("site.cub", cube(meridian, direction));
    const auto made = imported({.source = folder_ / "site.cub"});
    ASSERT_TRUE(made) << told(made);
    const auto middle = BodyDegrees(made->info.crs_wkt, made->info.body).to_degrees({0.0, 0.0});
    ASSERT_TRUE(middle);
    EXPECT_NEAR(middle->x, 137.5, 1e-6) << direction;
    EXPECT_EQ(made->lowest_m, 1000.0);
  }
}

// A PDS3 image of 4 x 5 cells of 20 m at the Moon's south pole.
std::string pds_label(const std::string& of_image, const std::string& of_projection) {
  return "PDS_VERSION_ID = \"PDS3\"\r\nRECORD_TYPE = FIXED_LENGTH\r\nRECORD_BYTES = 10\r\n"
         "FILE_RECORDS = 4\r\n^IMAGE = \"dem.img\"\r\nTARGET_NAME = MOON\r\nOBJECT = IMAGE\r\n  LINES = 4\r\n"
         "  LINE_SAMPLES = 5\r\n  SAMPLE_TYPE = LSB_INTEGER\r\n  SAMPLE_BITS = 16\r\n" +
         of_image +
         "END_OBJECT = IMAGE\r\nOBJECT = IMAGE_MAP_PROJECTION\r\n"
         "  A_AXIS_RADIUS = 1737.4 <KM>\r\n  B_AXIS_RADIUS = 1737.4 <KM>\r\n  C_AXIS_RADIUS = 1737.4 "
         "<KM>\r\n" +
         of_projection +
         "  LINE_FIRST_PIXEL = 1\r\n  SAMPLE_FIRST_PIXEL = 1\r\n  MAP_SCALE = 0.020 <KM/PIXEL>\r\n"
         "  LINE_PROJECTION_OFFSET = 1.5\r\n  SAMPLE_PROJECTION_OFFSET = 2.0\r\n"
         "END_OBJECT = IMAGE_MAP_PROJECTION\r\nEND\r\n";
}

TEST_F(RasterMeaning, RadiiOfALolaLabelAreHeightsAboveTheSphere) {
  std::string cells;
  for (int i = 0; i < 20; ++i) {
    const auto stored = static_cast<std::int16_t>(-2960 + i);
    cells.append(reinterpret_cast<const char*>(&stored), sizeof stored);
  }
  folder_.write("dem.img", cells);
  const std::string pole =
      "  MAP_PROJECTION_TYPE = \"POLAR STEREOGRAPHIC\"\r\n  POSITIVE_LONGITUDE_DIRECTION = EAST\r\n"
      "  CENTER_LATITUDE = -90.0 <DEG>\r\n  CENTER_LONGITUDE = 0.0 <DEG>\r\n";
  folder_.write("dem.lbl",
                pds_label("  UNIT = METER\r\n  SCALING_FACTOR = 0.5\r\n  OFFSET = 1737400.0\r\n", pole));
  auto made = imported({.source = folder_ / "dem.lbl"});
  ASSERT_TRUE(made) << told(made);
  EXPECT_EQ(made->lowest_m, -1480.0);
  EXPECT_EQ(made->highest_m, -1470.5);
  expect_parts(told(made), {"distances from the body's centre", "1737400 m, was taken off"});
  folder_.write("dem.lbl",
                pds_label("  UNIT = KILOMETER\r\n  SCALING_FACTOR = 0.0005\r\n  OFFSET = 1737.4\r\n", pole));
  made = imported({.source = folder_ / "dem.lbl"});
  ASSERT_TRUE(made) << told(made);
  EXPECT_NEAR(made->lowest_m, -1480.0, 1e-3);
  const std::string west =
      "  MAP_PROJECTION_TYPE = \"SIMPLE CYLINDRICAL\"\r\n  POSITIVE_LONGITUDE_DIRECTION = \"WEST\"\r\n"
      "  CENTER_LATITUDE = 0.0 <DEG>\r\n  CENTER_LONGITUDE = 222.5 <DEG>\r\n";
  folder_.write("dem.lbl", pds_label("", west));
  made = imported({.source = folder_ / "dem.lbl"});
  ASSERT_TRUE(made) << told(made);
  const auto middle = BodyDegrees(made->info.crs_wkt, made->info.body).to_degrees({0.0, 0.0});
  ASSERT_TRUE(middle);
  EXPECT_NEAR(middle->x, 137.5, 1e-6);
}

TEST_F(RasterMeaning, HeightsThatTheBodyHasNowhereAreToldOf) {
  const auto made = imported(plain(23000.0F));
  ASSERT_TRUE(made) << told(made);
  expect_parts(told(made), {"more than Mars has anywhere"});
}

}  // namespace
}  // namespace slipway::dem
