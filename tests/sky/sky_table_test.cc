#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/angle.h"
#include "core/utc.h"
#include "sky/sky.h"

namespace slipway::sky {
namespace {

Bearing bearing(double azimuth_deg, double elevation_deg) {
  return {rad_from_deg(azimuth_deg), rad_from_deg(elevation_deg)};
}

TEST(SkyTable, GoesThroughNorthBetweenItsMoments) {
  const SkyTable table({{0, bearing(350.0, 1.0), {}, 1.0}, {1000, bearing(10.0, 1.0), {}, 1.0}});
  const auto sun = table.sun(500);
  ASSERT_TRUE(sun);
  EXPECT_NEAR(std::sin(sun->azimuth_rad), 0.0, 1e-9);
  EXPECT_NEAR(deg_from_rad(sun->elevation_rad), 1.015, 1e-3);
  EXPECT_FALSE(table.sun(-1));
  EXPECT_FALSE(table.sun(1001));
  EXPECT_FALSE(table.earth(500));
}

TEST(SkyTable, RefusesTimesThatDoNotRise) {
  EXPECT_THROW(SkyTable({{5, bearing(0.0, 1.0), {}, 1.0}, {5, bearing(1.0, 1.0), {}, 1.0}}),
               std::invalid_argument);
  EXPECT_THROW(SkyTable({{5, bearing(0.0, 1.0), {}, 1.0}}), std::invalid_argument);
}

TEST(SkyOverMap, CountsFromTheMapsNorth) {
  const auto table = std::make_shared<SkyTable>(
      std::vector<SkySample>{{0, bearing(10.0, 5.0), {}, 1.0}, {1000, bearing(10.0, 5.0), {}, 1.0}});
  EXPECT_NEAR(deg_from_rad(SkyOverMap(table, rad_from_deg(30.0)).sun(0)->azimuth_rad), 340.0, 1e-9);
}

TEST(SkyTable, OfMarsIsNearTheFormulasBetweenItsMoments) {
  const MarsSky mars(rad_from_deg(77.4), rad_from_deg(18.4));
  const std::int64_t from = utc_of_text("2026-11-29T00:00:00Z").value(), to = from + 86'400'000;
  const SkyTable table = table_of(mars, from, to, true);
  double worst = 0.0;
  for (std::int64_t at = from; at < to; at += 777'777)
    for (const auto& [a, b] : {std::pair{table.sun(at), mars.sun(at)}, {table.earth(at), mars.earth(at)}}) {
      ASSERT_TRUE(a && b);
      worst = std::max(worst, towards(*a).cross(towards(*b)).norm());
    }
  EXPECT_LT(deg_from_rad(worst), 0.005);
}

// Five kilometres away, by the formulas of both places.
TEST(Bearing, IsSeenFromAPlaceBeside) {
  constexpr double kRadius_m = 3'396'190.0, kEast_m = 4'000.0, kNorth_m = 3'000.0;
  const double east = rad_from_deg(137.4), latitude = rad_from_deg(-4.6);
  const MarsSky here(east, latitude),
      there(east + kEast_m / (kRadius_m * std::cos(latitude)), latitude + kNorth_m / kRadius_m);
  const std::int64_t from = utc_of_text("2026-11-29T00:00:00Z").value();
  double moved = 0.0, missed = 0.0;
  for (std::int64_t at = from; at < from + 86'400'000; at += 3'600'000) {
    const Eigen::Vector3d before = towards(*here.sun(at)), after = towards(*there.sun(at));
    moved = std::max(moved, before.cross(after).norm());
    missed = std::max(
        missed,
        towards(seen_from(*here.sun(at), kEast_m / kRadius_m, kNorth_m / kRadius_m)).cross(after).norm());
  }
  EXPECT_GT(deg_from_rad(moved), 0.08);
  EXPECT_LT(deg_from_rad(missed), 0.01);
}

}  // namespace
}  // namespace slipway::sky
