#include "dem/body_degrees.h"

#include <gtest/gtest.h>
#include <ogr_spatialref.h>

#include <cmath>
#include <string>

namespace slipway::dem {
namespace {

std::string wkt_of(const std::string& proj) {
  OGRSpatialReference crs;
  EXPECT_EQ(crs.SetFromUserInput(proj.c_str()), OGRERR_NONE);
  char* text = nullptr;
  const char* options[] = {"FORMAT=WKT2_2019", nullptr};
  crs.exportToWkt(&text, options);
  std::string wkt(text);
  CPLFree(text);
  return wkt;
}

TEST(BodyDegrees, OnASphereTheyAreWhatTheProjectionSays) {
  const BodyDegrees degrees(wkt_of("+proj=eqc +lat_ts=0 +lon_0=0 +R=3396190 +units=m +no_defs"), "Mars");
  constexpr double kMetresPerDegree = 3396190.0 * M_PI / 180.0;
  const auto place = degrees.to_degrees({137.4 * kMetresPerDegree, -4.6 * kMetresPerDegree});
  ASSERT_TRUE(place);
  EXPECT_NEAR(place->x, 137.4, 1e-9);
  EXPECT_NEAR(place->y, -4.6, 1e-9);
  const auto back = degrees.to_map(*place);
  ASSERT_TRUE(back);
  EXPECT_NEAR(back->x, 137.4 * kMetresPerDegree, 1e-6);
  EXPECT_NEAR(back->y, -4.6 * kMetresPerDegree, 1e-6);
}

TEST(BodyDegrees, OnAnEllipsoidLatitudesArePlanetocentricButOnTheEarth) {
  const std::string map =
      wkt_of("+proj=tmerc +lat_0=45 +lon_0=10 +k=1 +x_0=0 +y_0=0 +a=3396190 +b=3376200 +units=m +no_defs");
  const BodyDegrees mars(map, "Mars"), earth(map, "Earth");
  EXPECT_NEAR(earth.to_degrees({0.0, 0.0}).value().y, 45.0, 1e-9);
  const double centric = std::atan(3376200.0 * 3376200.0 / (3396190.0 * 3396190.0)) * 180.0 / M_PI;
  EXPECT_NEAR(mars.to_degrees({0.0, 0.0}).value().y, centric, 1e-9);
  EXPECT_NEAR(mars.to_map({10.0, centric}).value().y, 0.0, 1e-6);
}

TEST(BodyDegrees, ALocalFrameLiesOnNoBody) {
  const BodyDegrees nowhere("", "other");
  EXPECT_FALSE(nowhere.usable());
  EXPECT_FALSE(nowhere.to_degrees({0.0, 0.0}));
  EXPECT_FALSE(nowhere.to_map({0.0, 0.0}));
}

}  // namespace
}  // namespace slipway::dem
