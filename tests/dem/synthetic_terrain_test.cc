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

TEST(SyntheticTerrain, ReliefAddsRippleAndBumpsToASlope) {
  const SyntheticGrid grid{.size_m = 40.0, .cell_m = 0.25};
  const double rise = std::tan(0.1);
  const auto ripple = make_relief(grid, {.slope_rad = 0.1, .ripple = Relief::Ripple{0.5, 5.0, 3.125}});
  EXPECT_NEAR(*ripple->height_m(3.125, 1.125), rise * 3.125 + 0.5, 1e-5);
  EXPECT_NEAR(*ripple->height_m(6.125, 1.125), rise * 6.125, 1e-5);
  const Relief::Roughness roughness{.rms_m = 0.05, .lattice_m = 0.5, .seed = 3};
  const auto rough = make_relief(grid, {.roughness = roughness});
  double sum_m2 = 0.0;
  int count = 0;
  for (int row = 1; row < 159; ++row) {
    for (int column = 1; column < 159; ++column) {
      const double height_m = *rough->height_m(Cell{row, column});
      sum_m2 += height_m * height_m;
      ++count;
    }
  }
  // Between the lattice's points the blend of four has less spread than they.
  const double rms_m = std::sqrt(sum_m2 / count);
  EXPECT_GT(rms_m, 0.5 * roughness.rms_m);
  EXPECT_LT(rms_m, roughness.rms_m);
  EXPECT_EQ(rough->fingerprint(), make_relief(grid, {.roughness = roughness})->fingerprint());
  EXPECT_NE(rough->fingerprint(),
            make_relief(grid, {.roughness = Relief::Roughness{0.05, 0.5, 4}})->fingerprint());
}

}  // namespace
}  // namespace slipway::dem
