#include <cpl_vsi.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <ogrsf_frmts.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <numbers>

#include "dem/body_degrees.h"
#include "dem/gdal_soil_units.h"
#include "dem/soil_legend.h"
#include "dem/soil_map.h"
#include "raster_fixture.h"

// Maps of units as people have them: in several formats and systems, and with longitudes that go round.
namespace slipway::dem {
namespace {

using test::TemporaryFolder;
using test::write_geotiff;

constexpr double kMetresPerDegree = 3396190.0 * std::numbers::pi / 180.0;
const std::vector<SoilClass> kLegend{{0, "1", "sand"}, {0, "2", "rock"}};

// A rectangle in degrees; with heights of its places where they are asked for.
std::string rectangle(double west, double south, double east, double north, bool heights = false) {
  const auto place = [&](double x, double y) {
    return fmt::format("[{:.12f},{:.12f}{}]", x, y, heights ? ",5.0" : "");
  };
  return fmt::format("[[{},{},{},{},{}]]", place(west, south), place(east, south), place(east, north),
                     place(west, north), place(west, south));
}

std::string feature(const std::string& label, const std::string& rings) {
  return fmt::format(
      R"({{"type":"Feature","properties":{{"unit":{}}},"geometry":{{"type":"Polygon","coordinates":{}}}}})",
      label, rings);
}

std::string collection(const std::string& features, const std::string& crs = "") {
  const std::string member =
      crs.empty() ? "" : R"("crs":{"type":"name","properties":{"name":")" + crs + R"("}},)";
  return R"({"type":"FeatureCollection",)" + member + R"("features":[)" + features + "]}";
}

class SoilUnitsTest : public testing::Test {
 protected:
  // 20 x 20 cells of 1 m with their middle at a longitude and latitude, which x may reach in any turn.
  ElevationInfo ground_at(double longitude, double latitude, const char* crs = test::kMarsSphere) {
    const double x = longitude * kMetresPerDegree, y = latitude * kMetresPerDegree;
    write_geotiff(folder_ / "dem.tif",
                  {.rows = 20, .columns = 20, .transform = {x - 10, 1, 0, y + 10, 0, -1}, .crs = crs});
    return open_elevation(folder_ / "dem.tif").value()->info();
  }

  Result<std::shared_ptr<const SoilMap>> read(
      const ElevationInfo& ground, const std::filesystem::path& file,
      PolygonCoordinates coordinates = PolygonCoordinates::kLongitudeLatitude) {
    return read_soil_polygons(file, ground, ground.geometry.extent(), "unit", coordinates, kLegend);
  }

  // The shares of the map that units 1 and 2 cover.
  std::pair<double, double> shares(const ElevationInfo& ground, const std::string& geojson,
                                   PolygonCoordinates coordinates = PolygonCoordinates::kLongitudeLatitude) {
    const auto map = read(ground, folder_.write("units.geojson", geojson), coordinates);
    EXPECT_TRUE(map) << (map ? "" : map.error().detail);
    if (!map) return {-1.0, -1.0};
    const auto cells = (*map)->cells_of_rows();
    return {static_cast<double>(cells[0]) / 400.0, static_cast<double>(cells[1]) / 400.0};
  }

  // The western half of a map around a place, in degrees.
  static std::string western_half(double longitude, double latitude, bool heights = false) {
    const double d = 10.0 / kMetresPerDegree;
    return rectangle(longitude - d, latitude - d, longitude, latitude + d, heights);
  }

  TemporaryFolder folder_;
};

using Shares = std::pair<double, double>;

TEST_F(SoilUnitsTest, LongitudesThatDifferBy360DegreesAreOnePlace) {
  for (const double of_map : {-5.53, 354.47, 226.5, -133.5, 179.99999, 180.0, -180.0, 540.0}) {
    const ElevationInfo ground = ground_at(of_map, -1.95);
    for (const double turn : {-360.0, 0.0, 360.0}) {
      const double longitude = std::remainder(of_map, 360.0) + turn;
      if (longitude < -359.0 || longitude > 719.0) continue;
      EXPECT_EQ(shares(ground, collection(feature("1", western_half(longitude, -1.95)))), Shares(0.5, 0.0))
          << of_map << " " << longitude;
      const BodyDegrees degrees(ground.crs_wkt, ground.body, ground.geometry.extent());
      const auto place = degrees.to_map({longitude, -1.95});
      ASSERT_TRUE(place);
      EXPECT_NEAR(place->x, of_map * kMetresPerDegree, 1e-3) << longitude;
      EXPECT_NEAR(std::remainder(degrees.to_degrees(*place)->x - of_map, 360.0), 0.0, 1e-9);
    }
  }
}

TEST_F(SoilUnitsTest, PolygonsOverTheAntimeridianCoverBothSidesOfIt) {
  const double d = 10.0 / kMetresPerDegree;
  for (const double of_map : {180.0, -180.0}) {
    const ElevationInfo ground = ground_at(of_map, 0.0);
    // Beyond 180 deg, over -180 deg, and with a step as from before RFC 7946.
    EXPECT_EQ(shares(ground, collection(feature("1", rectangle(179, 0, 181, d)))), Shares(0.5, 0.0));
    EXPECT_EQ(shares(ground, collection(feature("1", rectangle(-181, 0, -179, d)))), Shares(0.5, 0.0));
    EXPECT_EQ(shares(ground, collection(feature("1", rectangle(179, 0, -179, d)))), Shares(0.5, 0.0));
    // Cut there, as RFC 7946 wants it.
    EXPECT_EQ(shares(ground, collection(feature("1", rectangle(179, 0, 180, d)) + "," +
                                        feature("2", rectangle(-180, 0, -179, d)))),
              Shares(0.25, 0.25));
    // All round the body.
    EXPECT_EQ(shares(ground, collection(feature("1", rectangle(-180, 0, 180, d)))), Shares(0.5, 0.0));
    EXPECT_EQ(shares(ground, collection(feature("1", rectangle(0, 0, 360, d)))), Shares(0.5, 0.0));
  }
}

TEST_F(SoilUnitsTest, EdgesAreStraightInDegreesOnAPolarMap) {
  write_geotiff(folder_ / "dem.tif", {.rows = 20,
                                      .columns = 20,
                                      .transform = {-10, 1, 0, 10, 0, -1},
                                      .crs = "+proj=stere +lat_0=-90 +lon_0=0 +k=1 +R=1737400 +units=m"});
  const ElevationInfo ground = open_elevation(folder_ / "dem.tif").value()->info();
  EXPECT_EQ(shares(ground, collection(feature("1", rectangle(0, -90, 180, -89)))), Shares(0.5, 0.0));
  EXPECT_EQ(shares(ground, collection(feature("1", rectangle(-180, -90, 180, -89)))), Shares(1.0, 0.0));
}

TEST_F(SoilUnitsTest, WholeRealNumbersHeightsBomsAndEmptyGeometriesAreTaken) {
  const ElevationInfo ground = ground_at(137.4, -4.6);
  EXPECT_EQ(shares(ground, collection(feature("1.0", western_half(137.4, -4.6)))), Shares(0.5, 0.0));
  EXPECT_EQ(shares(ground, collection(feature("2", western_half(137.4, -4.6, true)))), Shares(0.0, 0.5));
  EXPECT_EQ(shares(ground, "\xEF\xBB\xBF" + collection(feature("\"1\"", western_half(137.4, -4.6)))),
            Shares(0.5, 0.0));
  EXPECT_EQ(shares(ground, collection(R"({"type":"Feature","properties":{"unit":1},"geometry":null},)" +
                                      feature("1", western_half(137.4, -4.6)))),
            Shares(0.5, 0.0));
  EXPECT_FALSE(
      read(ground, folder_.write("u.geojson", collection(feature("1.5", western_half(137.4, -4.6))))));
}

TEST_F(SoilUnitsTest, TheFilesOwnSystemIsHonoured) {
  const ElevationInfo ground = ground_at(137.4, -4.6);
  const Extent map = ground.geometry.extent();
  const double x = 0.5 * (map.west_m + map.east_m);
  // Metres about another meridian, and on a sphere of another name for the same body.
  const std::string about_137 = "+proj=eqc +lat_ts=0 +lon_0=137.4 +R=3396190 +units=m";
  const std::string half = feature("1", rectangle(-10, map.south_m, 0, map.north_m));
  EXPECT_EQ(shares(ground, collection(half, about_137)), Shares(0.5, 0.0));
  EXPECT_EQ(shares(ground, collection(half, about_137), PolygonCoordinates::kMap), Shares(0.5, 0.0));
  // What every tool writes is degrees of the map's body.
  for (const char* name : {"urn:ogc:def:crs:OGC:1.3:CRS84", "urn:ogc:def:crs:EPSG::4326", "EPSG:4326"})
    EXPECT_EQ(shares(ground, collection(feature("1", western_half(137.4, -4.6)), name)), Shares(0.5, 0.0))
        << name;
  // In metres of the map, whatever the file is named.
  EXPECT_EQ(shares(ground,
                   collection(feature("1", rectangle(map.west_m, map.south_m, x, map.north_m)),
                              "urn:ogc:def:crs:OGC::Engineering"),
                   PolygonCoordinates::kMap),
            Shares(0.5, 0.0));
}

TEST_F(SoilUnitsTest, SystemsWithoutAPlaceOnTheMapAreRefused) {
  const ElevationInfo ground = ground_at(137.4, -4.6);
  for (const char* name : {"urn:ogc:def:crs:OGC::Engineering", "https://example.com/crs", "a system of ours",
                           "+proj=eqc +R=1737400 +units=m", "+proj=longlat +R=1737400",
                           "PROJCS[\\\"Ographic\\\",GEOGCS[\\\"Mars "
                           "Ographic\\\",DATUM[\\\"D\\\",SPHEROID[\\\"S\\\",3396190,0]],PRIMEM[\\\"P\\\",0],"
                           "UNIT[\\\"degree\\\",0.0174532925199433]],PROJECTION[\\\"Equirectangular\\\"],"
                           "UNIT[\\\"metre\\\",1]]"}) {
    const auto map =
        read(ground, folder_.write("u.geojson", collection(feature("1", rectangle(0, -80, 160, 0)), name)));
    ASSERT_FALSE(map) << name;
    EXPECT_EQ(map.error().code, ErrorCode::kUnsupportedCrs) << name;
  }
}

TEST_F(SoilUnitsTest, SwappedDegreesAndMapMetresAreNamed) {
  const ElevationInfo ground = ground_at(137.4, -4.6);
  const auto swapped = read(
      ground, folder_.write("u.geojson", collection(feature("1", rectangle(-4.61, 137.39, -4.59, 137.41)))));
  ASSERT_FALSE(swapped);
  EXPECT_NE(swapped.error().faults.at(0).message.find("swapped"), std::string::npos);
  const auto metres = read(
      ground, folder_.write("u.geojson", collection(feature("1", rectangle(8.14e6, -3e5, 8.15e6, -2e5)))));
  ASSERT_FALSE(metres);
  EXPECT_NE(metres.error().faults.at(0).message.find("--map-coordinates"), std::string::npos);
}

TEST_F(SoilUnitsTest, WhatAPlaceOffTheMapWasMeantToBeIsSaid) {
  const ElevationInfo ground = ground_at(354.47, -1.95);
  const Extent map = ground.geometry.extent();
  const auto meant = [&](double x, double y, bool degrees) {
    return likely_mistake(ground.crs_wkt, ground.body, map, {x, y}, degrees);
  };
  EXPECT_NE(meant(-1.95, 354.47, true).find("longitude and latitude are swapped"), std::string::npos);
  EXPECT_NE(meant(-1.95, -5.53, true).find("longitude and latitude are swapped"), std::string::npos);
  EXPECT_NE(meant(map.west_m + 1, map.south_m + 1, true).find("map metres"), std::string::npos);
  EXPECT_NE(meant(map.south_m + 1, map.west_m + 1, false).find("x and y are swapped"), std::string::npos);
  EXPECT_NE(meant(-5.53, -1.95, false).find("longitude and latitude in degrees"), std::string::npos);
  EXPECT_NE(meant(-1.95, 354.47, false).find("latitude and longitude in degrees, in this order"),
            std::string::npos);
  EXPECT_EQ(meant(10.0, 10.0, true), "");
}

TEST_F(SoilUnitsTest, CoverIsToldAndNothingAndEverythingAreWarnedOf) {
  const ElevationInfo ground = ground_at(137.4, -4.6);
  const auto cover = [&](const std::string& features) {
    return cover_of(**read(ground, folder_.write("u.geojson", collection(features))),
                    ground.geometry.extent(), "unit");
  };
  const SoilCover half = cover(feature("1", western_half(137.4, -4.6)));
  EXPECT_EQ(half.lines,
            (std::vector<std::string>{"unit 1 covers 50.0 % of the map", "unit 2 covers 0.0 % of the map",
                                      "no unit of the legend covers 50.0 % of the map: unknown ground"}));
  EXPECT_EQ(half.warnings, std::vector<std::string>{"0 % of the map is covered by 2"});
  const SoilCover all = cover(feature("1", rectangle(137, -5, 138, -4)));
  ASSERT_EQ(all.warnings.size(), 2U);
  EXPECT_NE(all.warnings[0].find("unit 1 covers 100 % of the map"), std::string::npos);
  const SoilCover none = cover(feature("1", rectangle(222, -5, 223, -4)));
  EXPECT_TRUE(none.is_empty);
  ASSERT_EQ(none.warnings.size(), 1U);
  EXPECT_NE(none.warnings[0].find("0 % of the map"), std::string::npos);
}

TEST_F(SoilUnitsTest, OnTheEarthDatumsAreTransformed) {
  // 20 m around 600000 E, 4000000 N of UTM zone 10 on NAD83; units in WGS 84, Web Mercator and the map's own.
  write_geotiff(
      folder_ / "dem.tif",
      {.rows = 20, .columns = 20, .transform = {599990, 1, 0, 4000010, 0, -1}, .crs = "EPSG:26910"});
  const ElevationInfo ground = open_elevation(folder_ / "dem.tif").value()->info();
  const BodyDegrees degrees(ground.crs_wkt, ground.body, ground.geometry.extent());
  const auto middle = degrees.to_degrees({600000, 4000000}).value();
  const double r = 6378137.0 * std::numbers::pi / 180.0;
  const double x = middle.x * r;
  const double y = 6378137.0 * std::log(std::tan(std::numbers::pi / 4 + middle.y * std::numbers::pi / 360.0));
  for (const auto& [name, rings] :
       {std::pair<std::string, std::string>{
            "EPSG:4326", rectangle(middle.x - 0.1, middle.y - 0.1, middle.x, middle.y + 0.1)},
        {"", rectangle(middle.x - 0.1, middle.y - 0.1, middle.x, middle.y + 0.1)},
        {"urn:ogc:def:crs:EPSG::3857", rectangle(x - 1e4, y - 1e4, x, y + 1e4)},
        {"EPSG:26910", rectangle(599000, 3999000, 600000, 4001000)}}) {
    const Shares found = shares(ground, collection(feature("1", rings), name));
    EXPECT_NEAR(found.first, 0.5, 0.051) << name;  // a column of cells, for the convergence of meridians
  }
}

// Files of vectors that GDAL makes in memory, which are then written to the folder.
class VectorUnits : public SoilUnitsTest {
 protected:
  void SetUp() override {
    test::prepare_gdal();
    RegisterOGRShape();
    RegisterOGRGeoPackage();
  }

  struct Order {
    const char* driver;
    std::string file, crs;  // as it is made; the ending may be put in capital letters afterwards
    OGRFieldType type = OFTString;
    double west, south, east, north;
    std::vector<std::string> endings;
    bool capitals = false;
  };

  void make(const Order& order) {
    const std::string base = "/vsimem/made_units";
    GDALDatasetUniquePtr made(GetGDALDriverManager()
                                  ->GetDriverByName(order.driver)
                                  ->Create((base + order.endings[0]).c_str(), 0, 0, 0, GDT_Unknown, nullptr));
    ASSERT_TRUE(made);
    OGRSpatialReference crs;
    if (!order.crs.empty()) {
      ASSERT_EQ(crs.SetFromUserInput(order.crs.c_str()), OGRERR_NONE);
    }
    OGRLayer* const layer =
        made->CreateLayer("made_units", order.crs.empty() ? nullptr : &crs, wkbPolygon25D, nullptr);
    ASSERT_TRUE(layer != nullptr);
    OGRFieldDefn field("unit", order.type);
    ASSERT_EQ(layer->CreateField(&field), OGRERR_NONE);
    for (const bool empty : {true, false}) {
      OGRFeature row(layer->GetLayerDefn());
      row.SetField(0, 1.0);
      if (order.type == OFTString) row.SetField(0, "1");
      OGRLinearRing ring;
      ring.addPoint(order.west, order.south, 3.0);
      ring.addPoint(order.east, order.south, 3.0);
      ring.addPoint(order.east, order.north, 3.0);
      ring.addPoint(order.west, order.north, 3.0);
      ring.closeRings();
      OGRPolygon polygon;
      polygon.addRing(&ring);
      if (!empty) row.SetGeometry(&polygon);
      ASSERT_EQ(layer->CreateFeature(&row), OGRERR_NONE);
    }
    made.reset();
    for (const std::string& ending : order.endings) {
      vsi_l_offset size = 0;
      GByte* const bytes = VSIGetMemFileBuffer((base + ending).c_str(), &size, TRUE);
      if (bytes == nullptr) continue;
      std::string name = order.file + ending;
      if (order.capitals)
        std::transform(name.begin(), name.end(), name.begin(),
                       [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
      folder_.write(name, std::string(reinterpret_cast<const char*>(bytes), size));
      VSIFree(bytes);
    }
  }

  Shares shares_of(const ElevationInfo& ground, const std::string& file,
                   PolygonCoordinates coordinates = PolygonCoordinates::kLongitudeLatitude) {
    const auto map = read(ground, folder_ / file, coordinates);
    EXPECT_TRUE(map) << (map ? "" : map.error().detail);
    if (!map) return {-1.0, -1.0};
    const auto cells = (*map)->cells_of_rows();
    return {static_cast<double>(cells[0]) / 400.0, static_cast<double>(cells[1]) / 400.0};
  }

  static constexpr double kD = 10.0 / kMetresPerDegree;
  const std::vector<std::string> shapefile_{".shp", ".shx", ".dbf", ".prj", ".cpg"};
};

TEST_F(VectorUnits, ShapefilesAndGeoPackagesAreTakenInDegreesAndInMetres) {
  const ElevationInfo ground = ground_at(137.4, -4.6);
  const Extent map = ground.geometry.extent();
  const double middle = 0.5 * (map.west_m + map.east_m);
  const std::string degrees =
      "GEOGCS[\"Mars\",DATUM[\"D_Mars\",SPHEROID[\"Mars\",3396190,0]],PRIMEM[\"0\",0],UNIT[\"degree\",0."
      "0174532925199433]]";
  for (const bool capitals : {false, true}) {
    for (const OGRFieldType type : {OFTString, OFTReal, OFTInteger}) {
      make({"ESRI Shapefile", "units", degrees, type, 137.4 - kD, -4.6 - kD, 137.4, -4.6 + kD, shapefile_,
            capitals});
      EXPECT_EQ(shares_of(ground, capitals ? "UNITS.SHP" : "units.shp"), Shares(0.5, 0.0));
      make({"GPKG", "units", degrees, type, 137.4 - kD, -4.6 - kD, 137.4, -4.6 + kD, {".gpkg"}, capitals});
      EXPECT_EQ(shares_of(ground, capitals ? "UNITS.GPKG" : "units.gpkg"), Shares(0.5, 0.0));
    }
  }
  make({"ESRI Shapefile", "metres", test::kMarsSphere, OFTString, map.west_m, map.south_m, middle,
        map.north_m, shapefile_});
  EXPECT_EQ(shares_of(ground, "metres.shp"), Shares(0.5, 0.0));
  make({"GPKG",
        "metres",
        test::kMarsSphere,
        OFTString,
        map.west_m,
        map.south_m,
        middle,
        map.north_m,
        {".gpkg"}});
  EXPECT_EQ(shares_of(ground, "metres.gpkg"), Shares(0.5, 0.0));
}

TEST_F(VectorUnits, AShapefileWithoutASystemIsWhatItIsStatedToBe) {
  const ElevationInfo ground = ground_at(354.47, -4.6);
  const Extent map = ground.geometry.extent();
  make({"ESRI Shapefile", "units", "", OFTString, -5.53 - kD, -4.6 - kD, -5.53, -4.6 + kD, {".shp", ".dbf"}});
  EXPECT_EQ(shares_of(ground, "units.shp"), Shares(0.5, 0.0));
  make({"ESRI Shapefile", "metres", "", OFTString, map.west_m, map.south_m, map.east_m, map.south_m + 10,
        shapefile_});
  EXPECT_EQ(shares_of(ground, "metres.shp", PolygonCoordinates::kMap), Shares(0.5, 0.0));
}

TEST_F(VectorUnits, AnImportWritesTheMapsMetresAndTellsTheCover) {
  const ElevationInfo ground = ground_at(226.5, 18.6);
  const double west = 226.5 - 360.0;
  make(
      {"ESRI Shapefile", "units", "EPSG:4326", OFTString, west - kD, 18.6 - kD, west, 18.6 + kD, shapefile_});
  const auto made = import_soil_units(folder_ / "units.shp", "unit", PolygonCoordinates::kLongitudeLatitude,
                                      kLegend, ground, folder_ / "soil_units.geojson");
  ASSERT_TRUE(made) << made.error().detail;
  EXPECT_EQ(made->labels, std::vector<std::string>{"1"});
  EXPECT_EQ(made->cover.lines.at(0), "unit 1 covers 50.0 % of the map");
  EXPECT_EQ(made->notes.size(), 2U);  // a feature without a geometry, and a system of the Earth
  EXPECT_TRUE(made->in_map_metres);
  EXPECT_EQ(shares_of(ground, "soil_units.geojson", PolygonCoordinates::kMap), Shares(0.5, 0.0));
}

TEST_F(SoilUnitsTest, AnImportThatCoversNothingSaysWhereTheUnitsLie) {
  const ElevationInfo ground = ground_at(40.0, 20.0);
  const auto warned = [&](const std::string& rings) {
    std::filesystem::remove(folder_ / "out.geojson");
    const auto made =
        import_soil_units(folder_.write("u.geojson", collection(feature("1", rings))), "unit",
                          PolygonCoordinates::kLongitudeLatitude, kLegend, ground, folder_ / "out.geojson");
    EXPECT_TRUE(made);
    return made && !made->cover.warnings.empty() ? made->cover.warnings.back() : std::string();
  };
  const std::string elsewhere = warned(rectangle(10, 10, 11, 11));
  EXPECT_NE(elsewhere.find("x of 10 to 11 and y of 10 to 11"), std::string::npos) << elsewhere;
  EXPECT_NE(elsewhere.find("around 40 deg E, 20 deg N"), std::string::npos) << elsewhere;
  EXPECT_EQ(elsewhere.find("swapped"), std::string::npos) << elsewhere;
  const double d = 5.0 / kMetresPerDegree;
  EXPECT_NE(warned(rectangle(20 - d, 40 - d, 20 + d, 40 + d)).find("swapped"), std::string::npos);
}

TEST_F(VectorUnits, WhatIsMissingIsNamed) {
  const ElevationInfo ground = ground_at(137.4, -4.6);
  make({"ESRI Shapefile", "units", "", OFTString, 137, -5, 138, -4, {".shp", ".shx"}});
  const auto no_table = read(ground, folder_ / "units.shp");
  ASSERT_FALSE(no_table);
  EXPECT_NE(no_table.error().detail.find("units.dbf"), std::string::npos);
  make({"GPKG", "units", "", OFTString, 137, -5, 138, -4, {".gpkg"}});
  const auto no_property = read_soil_polygons(folder_ / "units.gpkg", ground, ground.geometry.extent(),
                                              "Name", PolygonCoordinates::kMap, kLegend);
  ASSERT_FALSE(no_property);
  EXPECT_NE(no_property.error().detail.find("there are unit"), std::string::npos);
  EXPECT_FALSE(read(ground, folder_.write("broken.gpkg", "SQLite format 3")));
  EXPECT_FALSE(read(ground, folder_.write("broken.shp", "no")));
}

}  // namespace
}  // namespace slipway::dem
