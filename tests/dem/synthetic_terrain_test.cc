#include "dem/synthetic_terrain.h"

#include <gtest/gtest.h>

#include "core/angle.h"

namespace slipway::dem {
namespace {

TEST(SyntheticTerrain, AGridIsCentredOnTheOrigin) {
  const auto plane = make_plane({.size_m = 10.0, .cell_m = 0.5}, 3.0);
  EXPECT_EQ(plane->geometry().extent(), (Extent{-5.0, -5.0, 5.0, 5.0}));
  EXPECT_EQ(plane->height_m(1.3, -2.7), 3.0);
}

TEST(SyntheticTerrain, ARampRisesTowardsItsUphillDirection) {
  const auto ramp = make_ramp({}, rad_from_deg(20.0), rad_from_deg(90.0));  // towards north
  const auto point = ramp->surface(0.1, 0.2);
  ASSERT_TRUE(point);
  EXPECT_NEAR(deg_from_rad(point->slope_rad()), 20.0, 1e-4);
  EXPECT_NEAR(deg_from_rad(point->aspect_rad()), 180.0, 1e-3);  // downhill is south
  EXPECT_GT(*ramp->height_m(0.0, 5.0), *ramp->height_m(0.0, -5.0));
}

TEST(SyntheticTerrain, ARippleHasItsCrestAtTheOriginAndIsLevelBeyondItsFeet) {
  const auto ripple = make_ripple({.size_m = 4.0, .cell_m = 0.01}, 0.2, 1.0);
  EXPECT_NEAR(*ripple->height_m(0.0, 1.0), 0.2, 1e-3);
  EXPECT_NEAR(*ripple->height_m(0.25, -1.0), 0.1, 1e-3);
  EXPECT_EQ(*ripple->height_m(0.6, 0.0), 0.0);
  EXPECT_EQ(*ripple->height_m(-1.5, 0.0), 0.0);
}

TEST(SyntheticTerrain, ACraterIsAParaboloidBelowALevelRim) {
  const auto crater = make_crater({.size_m = 10.0, .cell_m = 0.05}, 4.0, 0.8);
  EXPECT_NEAR(*crater->height_m(0.0, 0.0), -0.8, 1e-3);
  EXPECT_NEAR(*crater->height_m(2.0, 0.0), -0.6, 1e-3);
  EXPECT_NEAR(*crater->height_m(0.0, -4.5), 0.0, 1e-12);
}

}  // namespace
}  // namespace slipway::dem
