#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "dem/soil_map.h"
#include "raster_fixture.h"

namespace slipway::dem {
namespace {

using test::TemporaryFolder;
using test::write_geotiff;

const std::vector<SoilClass> kLegend{{0, "A", "sand"}, {0, "B", "rock"}};

std::string feature(const std::string& label, const std::string& ring) {
  return R"({"type":"Feature","properties":{"Name":")" + label +
         R"("},"geometry":{"type":"Polygon","coordinates":[)" + ring + "]}}";
}

std::string collection(const std::string& features) {
  return R"({"type":"FeatureCollection","features":[)" + features + "]}";
}

class SoilPolygons : public testing::Test {
 protected:
  Result<std::shared_ptr<const SoilMap>> read(const std::string& geojson,
                                              PolygonCoordinates coordinates = PolygonCoordinates::kMap,
                                              const char* crs = test::kMarsSphere) const {
    write_geotiff(folder_ / "dem.tif",
                  {.rows = 10, .columns = 10, .transform = {0, 1, 0, 10, 0, -1}, .crs = crs});
    const ElevationInfo ground = open_elevation(folder_ / "dem.tif").value()->info();
    return read_soil_polygons(folder_.write("units.geojson", geojson), ground, ground.geometry.extent(),
                              "Name", coordinates, kLegend);
  }

  TemporaryFolder folder_;
};

TEST_F(SoilPolygons, ACellTakesTheClassOfTheLastPolygonThatHoldsItsCentre) {
  const auto map = read(collection(feature("A", "[[0,0],[6.4,0],[6.4,10],[0,10],[0,0]]") + "," +
                                   feature("B", "[[4,0],[6.6,0],[6.6,5],[4,5],[4,0]]")));
  ASSERT_TRUE(map) << map.error().detail;
  EXPECT_EQ((*map)->class_at(1.5, 2.5), 0);
  EXPECT_EQ((*map)->class_at(5.5, 2.5), 1);
  EXPECT_EQ((*map)->class_at(5.5, 7.5), 0);
  EXPECT_EQ((*map)->class_at(6.5, 2.5), 1);  // 6.6 is beyond the centre at 6.5
  EXPECT_FALSE((*map)->class_at(6.5, 7.5));  // 6.4 is not
  EXPECT_EQ((*map)->soils().at((*map)->soil_at(6.5, 2.5).value()), "rock");
}

TEST_F(SoilPolygons, ALabelThatTheLegendDoesNotHaveIsUnknownGroundAndCoversWhatIsUnderIt) {
  const auto map = read(collection(feature("A", "[[0,0],[10,0],[10,10],[0,10],[0,0]]") + "," +
                                   feature("Z", "[[0,0],[5,0],[5,10],[0,10],[0,0]]")));
  ASSERT_TRUE(map);
  EXPECT_FALSE((*map)->class_at(2.5, 5.0));
  EXPECT_DOUBLE_EQ((*map)->unknown_fraction(), 0.5);
}

TEST_F(SoilPolygons, AHoleInAPolygonIsNotInIt) {
  const auto map =
      read(collection(feature("A", "[[0,0],[10,0],[10,10],[0,10],[0,0]],[[4,4],[4,6],[6,6],[6,4],[4,4]]")));
  ASSERT_TRUE(map);
  EXPECT_FALSE((*map)->class_at(5.5, 5.5));
  EXPECT_DOUBLE_EQ((*map)->unknown_fraction(), 0.04);
}

// Degrees on the map's own sphere for a square of 10 m at the origin, whatever CRS the file claims.
TEST_F(SoilPolygons, DegreesLieOnTheElevationsOwnDatumWhateverTheFileClaims) {
  const double half_deg = 5.0 / 3396190.0 * 180.0 / std::numbers::pi;
  const std::string d = std::to_string(half_deg * 1e6);
  const std::string ring = "[[0,0],[" + d + "e-6,0],[" + d + "e-6,1],[0,1],[0,0]]";
  std::string text = collection(feature("A", ring));
  text.insert(1, R"("crs":{"type":"name","properties":{"name":"urn:ogc:def:crs:OGC:1.3:CRS84"}},)");
  const auto map = read(text, PolygonCoordinates::kLongitudeLatitude);
  ASSERT_TRUE(map) << map.error().detail;
  EXPECT_EQ((*map)->class_at(4.9, 5.0), 0);
  EXPECT_FALSE((*map)->class_at(5.1, 5.0));
}

TEST_F(SoilPolygons, OnAnEllipsoidLatitudesArePlanetocentric) {
  // Transverse Mercator at planetographic latitude 45 deg on Mars's ellipsoid: its origin is at a
  // planetocentric latitude of atan((b/a)^2), which is 0.34 deg less. A polygon that begins 5 m north of
  // there covers half the map.
  const double ratio = 3376200.0 / 3396190.0;
  const double centric_deg = std::atan(ratio * ratio) * 180.0 / std::numbers::pi;
  const double south_deg = centric_deg + 5.0 / 3.386e6 * 180.0 / std::numbers::pi;
  char ring[200];  // to a micrometre
  std::snprintf(ring, sizeof(ring), "[[-0.01,%.12f],[0.01,%.12f],[0.01,46],[-0.01,46],[-0.01,%.12f]]",
                south_deg, south_deg, south_deg);
  const auto map = read(collection(feature("A", ring)), PolygonCoordinates::kLongitudeLatitude,
                        "+proj=tmerc +lat_0=45 +lon_0=0 +a=3396190 +b=3376200 +units=m");
  ASSERT_TRUE(map) << map.error().detail;
  EXPECT_EQ((*map)->class_at(1.5, 9.5), 0);
  EXPECT_FALSE((*map)->class_at(1.5, 0.5));
}

TEST_F(SoilPolygons, AllFaultsAreReportedTogetherAndNameTheFeature) {
  const auto map = read(
      collection(
          "null," + feature("A", "[[0,0],[1,0],[1,1]]") + "," + feature("A", "[[0,0],[1,0],[1,1],[0,1]]") +
          "," + feature("A", "[[0,0],[1,\"q\"],[1,1],[0,0]]") + "," +
          feature("A", "[[0,0],[1,1e400],[1,1],[0,0]]") + "," +
          R"({"type":"Feature","properties":{"Name":"A"},"geometry":{"type":"Point","coordinates":[1,1]}},)" +
          R"({"type":"Feature","properties":{"Name":"A"}},)" +
          R"({"type":"Feature","properties":{},"geometry":{"type":"Polygon","coordinates":[[[0,0],[1,0],[1,1],[0,0]]]}},)" +
          feature("A", "[[0,0],[721,0],[1,1],[0,0]]") + "," + feature("A", "[[0,0],[1,91],[1,1],[0,0]]") +
          "," + feature("A", "[[0,0],[1,0],[1,1],[0,0]]")),
      PolygonCoordinates::kLongitudeLatitude);
  ASSERT_FALSE(map);
  EXPECT_EQ(map.error().code, ErrorCode::kUnreadableData);
  std::vector<std::string> pointers;
  for (const Fault& fault : map.error().faults) pointers.push_back(fault.pointer);
  EXPECT_EQ(pointers,
            (std::vector<std::string>{"/features/0", "/features/1/geometry", "/features/2/geometry",
                                      "/features/3/geometry", "/features/4/geometry", "/features/5/geometry",
                                      "/features/6/geometry", "/features/7/properties",
                                      "/features/8/geometry", "/features/9/geometry"}));
}

TEST_F(SoilPolygons, AFileThatIsNoFeatureCollectionIsRefused) {
  for (const char* text : {"", "{", "[]", "null", R"({"type":"Polygon"})", R"({"type":"FeatureCollection"})",
                           R"({"type":"FeatureCollection","features":{}})"}) {
    const auto map = read(text);
    ASSERT_FALSE(map) << text;
    EXPECT_EQ(map.error().code, ErrorCode::kUnreadableData) << text;
  }
}

TEST_F(SoilPolygons, DeepNestingIsRefusedAndTheProcessLives) {
  EXPECT_FALSE(read(std::string(100'000, '[')));
  EXPECT_FALSE(read(collection(feature("A", std::string(100'000, '[')))));
}

TEST_F(SoilPolygons, NoPolygonsAreUnknownGroundEverywhere) {
  const auto map = read(collection(""));
  ASSERT_TRUE(map);
  EXPECT_DOUBLE_EQ((*map)->unknown_fraction(), 1.0);
}

}  // namespace
}  // namespace slipway::dem
