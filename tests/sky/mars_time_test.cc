#include "sky/mars_time.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>

#include "core/angle.h"
#include "core/utc.h"
#include "tests/sky/degrees_between.h"

namespace slipway::sky {
namespace {

std::int64_t at(const char* utc) {
  return utc_of_text(utc).value();
}

// Mars24, Algorithm and Worked Examples (NASA GISS), example A: the prime meridian.
TEST(MarsTime, IsThatOfTheFirstPublishedExample) {
  const MarsTime time = mars_time(at("2000-01-06T00:00:00Z"), 0.0);
  EXPECT_NEAR(time.sol_date, 44795.99976, 1e-5);
  EXPECT_NEAR(deg_from_rad(time.season_rad), 277.18758, 2e-5);
  EXPECT_NEAR(15.0 * time.equation_of_time_h, -5.18774, 2e-5);
  EXPECT_NEAR(time.mean_solar_h, 23.99425, 1e-5);
  EXPECT_NEAR(time.true_solar_h, 23.0 + 38.0 / 60.0 + 54.0 / 3600.0, 1e-3);
  EXPECT_NEAR(time.sun_distance_au, 1.39358, 1e-4);
}

// Example B: where Spirit landed, then.
TEST(MarsTime, IsThatOfTheSecondPublishedExample) {
  const MarsTime time = mars_time(at("2004-01-03T13:46:31Z"), rad_from_deg(-184.702));
  EXPECT_NEAR(time.sol_date, 46215.54856, 2e-5);
  EXPECT_NEAR(deg_from_rad(time.season_rad), 327.32416, 2e-5);
  EXPECT_NEAR(15.0 * time.equation_of_time_h, -12.77553, 2e-5);
  EXPECT_NEAR(time.mean_solar_h, 0.85190, 2e-5);
  EXPECT_NEAR(time.true_solar_h, 0.00020, 2e-5);
}

TEST(MarsTime, CountsLeapSeconds) {
  EXPECT_NEAR(
      86400.0 * (terrestrial_days(at("2017-01-01T00:00:00Z")) - terrestrial_days(at("2016-12-31T23:59:59Z"))),
      2.0, 1e-3);
}

// Mars24's difference of terrestrial and universal time was 6 s in 1905.
TEST(MarsTime, BeforeLeapSecondsHasThePolynomial) {
  const std::int64_t then = at("1905-01-01T00:00:00Z");
  EXPECT_NEAR(86400.0 * (terrestrial_days(then) - (static_cast<double>(then) / 86.4e6 - 10957.5)), 6.0, 0.3);
}

// At true noon the sun is over the meridian, at the height that declination and latitude give; on the
// ellipsoid a place's level leans to its pole.
TEST(MarsSun, StandsOverTheMeridianAtTrueNoon) {
  const double east = rad_from_deg(137.4), latitude = rad_from_deg(18.4);
  std::int64_t noon = at("2021-03-01T00:00:00Z");
  for (int k = 0; k < 6; ++k)
    noon += std::llround((12.0 - mars_time(noon, east).true_solar_h) * 3600e3 * 88775.244 / 86400.0);
  const MarsTime time = mars_time(noon, east);
  ASSERT_NEAR(time.true_solar_h, 12.0, 1e-4);
  const Bearing sun = mars_sun(noon, east, latitude);
  EXPECT_NEAR(deg_from_rad(sun.azimuth_rad), 180.0, 0.01);
  const double graphic = std::atan(std::tan(latitude) * std::pow(3396.19 / 3376.20, 2));
  EXPECT_NEAR(deg_from_rad(sun.elevation_rad), 90.0 - deg_from_rad(graphic - time.declination_rad), 0.005);
}

// The mean elements of the Earth's orbit, which know nothing of Allison and McEwen's series, have the sun of
// Mars where these have it: seen from Mars at opposition the Earth stands before the sun.
TEST(MarsEarth, StandsBeforeTheSunAtOpposition) {
  // Opposition of 27 July 2018, 5 h UT [the Astronomical Almanac].
  const std::int64_t opposition = at("2018-07-27T05:07:00Z");
  for (const double east_deg : {0.0, 137.4, -120.0}) {
    const double east = rad_from_deg(east_deg), latitude = rad_from_deg(-4.6);
    // Their ecliptic longitudes are the same then; Mars stood 1.8 deg beside the ecliptic.
    EXPECT_LT(degrees_between(mars_sun(opposition, east, latitude), mars_earth(opposition, east, latitude)),
              6.0);
    EXPECT_GT(degrees_between(mars_sun(opposition, east, latitude), mars_earth(opposition, east, latitude)),
              2.0);
  }
}

TEST(MarsSky, IsNotComputedBeyondItsYears) {
  EXPECT_FALSE(why_not_known(at("1805-01-01T00:00:00Z")));
  EXPECT_FALSE(why_not_known(at("1800-01-01T00:00:00Z")));
  EXPECT_TRUE(why_not_known(at("1799-12-31T23:59:59Z")));
  EXPECT_FALSE(why_not_known(at("2150-12-31T23:59:59Z")));
  EXPECT_TRUE(why_not_known(at("2151-01-01T00:00:00Z")));
  EXPECT_TRUE(why_not_known(at("1700-01-01T00:00:00Z")));
  EXPECT_TRUE(why_not_known(at("9999-01-01T00:00:00Z")));
}

}  // namespace
}  // namespace slipway::sky
