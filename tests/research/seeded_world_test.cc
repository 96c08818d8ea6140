#include "research/validation/worlds/seeded_world.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "research/validation/worlds/world_soils.h"

namespace slipway::validation {
namespace {

TEST(SeededWorld, TheSameSeedGivesTheSameWorldAndAnotherSeedAnother) {
  const SeededWorld one = make_world({.seed = 4}), again = make_world({.seed = 4}),
                    two = make_world({.seed = 5});
  EXPECT_EQ(one.terrain->fingerprint(), again.terrain->fingerprint());
  EXPECT_NE(one.terrain->fingerprint(), two.terrain->fingerprint());
  ASSERT_EQ(one.patches.size(), again.patches.size());
  int differ = 0;
  for (std::size_t k = 0; k < one.patches.size(); ++k) {
    EXPECT_EQ(one.patches[k].soil_class, again.patches[k].soil_class);
    EXPECT_EQ(one.patches[k].hidden, again.patches[k].hidden);
    differ += one.patches[k].soil_class != two.patches[k].soil_class ? 1 : 0;
  }
  EXPECT_GT(differ, 10);
}

TEST(SeededWorld, CellsOfHalfAMetreHaveTheSameGround) {
  const SeededWorld coarse = make_world({.seed = 6}), fine = make_world({.seed = 6, .cell_m = 0.5});
  EXPECT_EQ(coarse.terrain->geometry().rows, 96);
  EXPECT_EQ(fine.terrain->geometry().rows, 192);
  for (int row = 0; row < 96; row += 5) {
    const Eigen::Vector2d p = coarse.terrain->geometry().centre_m({row, 40});
    EXPECT_NEAR(*coarse.terrain->height_m(p.x(), p.y()), *fine.terrain->height_m(p.x(), p.y()), 0.08) << row;
  }
}

// Midway up the wall, where no cell's height is of the floor or the rim.
TEST(SeededWorld, WallsOfCratersAreAsSteepAsTheyStateAndStatedFromTenToTwentyDegrees) {
  int walls = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const SeededWorld world = make_world({.seed = seed, .cell_m = 0.5, .rms_height_m = 0.0});
    for (const Crater& crater : world.craters) {
      EXPECT_GE(crater.wall_rad, rad_from_deg(10.0));
      EXPECT_LE(crater.wall_rad, rad_from_deg(20.0));
      const double r = 0.5 * (crater.floor_radius_m() + crater.radius_m);
      const auto surface = world.terrain->surface(crater.x_m + r, crater.y_m);
      ASSERT_TRUE(surface);
      // The rims of other craters lie over it.
      EXPECT_NEAR(deg_from_rad(surface->slope_rad()), deg_from_rad(crater.wall_rad), 1.0) << seed;
      for (const double at : {kWorldStart_m, kWorldGoal_m})
        EXPECT_GT(std::hypot(crater.x_m - at, crater.y_m - at), 1.3 * crater.radius_m);
      ++walls;
    }
  }
  EXPECT_GE(walls, 45);
}

constexpr double kNear_m = 4.0, kFar_m = 8.0;

// By how much the variance of differences of height grows from one distance to another, as half the exponent
// of a power law.
double exponent_of(double near, double far) {
  return 0.5 * std::log(far / near) / std::log(kFar_m / kNear_m);
}

double measured_exponent(double hurst) {
  double near = 0.0, far = 0.0;
  for (std::uint64_t seed = 1; seed <= 15; ++seed) {
    const SeededWorld world = make_world({.seed = seed, .hurst = hurst, .max_craters = 0});
    for (double x = 4.0; x < 80.0; x += 5.0) {
      for (double y = 4.0; y < 90.0; y += 5.0) {
        near += std::pow(world.height_m(x + kNear_m, y) - world.height_m(x, y), 2);
        far += std::pow(world.height_m(x + kFar_m, y) - world.height_m(x, y), 2);
      }
    }
  }
  return exponent_of(near, far);
}

// The same of waves in all directions whose variance grows with their length to the power 2 H, from 3 to 96 m
// and nothing beyond: an integral over the logarithm of the length.
double stated_exponent(double hurst) {
  double near = 0.0, far = 0.0;
  for (int k = 0; k < 500; ++k) {
    const double length_m = 96.0 * std::pow(3.0 / 96.0, (k + 0.5) / 500.0);
    const double variance = std::pow(length_m, 2.0 * hurst), wave = 2.0 * std::numbers::pi / length_m;
    near += variance * (1.0 - std::cyl_bessel_j(0.0, wave * kNear_m));
    far += variance * (1.0 - std::cyl_bessel_j(0.0, wave * kFar_m));
  }
  return exponent_of(near, far);
}

TEST(SeededWorld, TheGroundHasTheStatedExponentAndHeight) {
  for (const double hurst : {0.8, 0.4})
    EXPECT_NEAR(measured_exponent(hurst), stated_exponent(hurst), 0.05) << hurst;
  double square = 0.0;
  int count = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const SeededWorld world = make_world({.seed = seed, .rms_height_m = 0.5, .max_craters = 0});
    for (double x = 5.0; x < 96.0; x += 18.0) {
      square += std::pow(world.height_m(x, 96.0 - x), 2);
      ++count;
    }
  }
  EXPECT_NEAR(std::sqrt(square / count), 0.5, 0.05);
}

TEST(SeededWorld, EveryClassHasItsShareAndAThirdOfTheAreaIsHidden) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const SeededWorld world = make_world({.seed = seed});
    std::array<int, kWorldSoils> patches{};
    for (const SoilPatch& patch : world.patches) ++patches[static_cast<std::size_t>(patch.soil_class)];
    for (const int count : patches) EXPECT_TRUE(count == 3 || count == 4) << count;
    EXPECT_NEAR(world.soil_map->unknown_fraction(), 1.0 / 3.0, 0.03) << seed;
    for (const double at : {10.5, 50.5, 80.5}) {
      const SoilPatch& patch = world.patches[world.patch_at(at, at)];
      const auto soil = world.soil_map->soil_at(at, at);
      EXPECT_EQ(soil.has_value(), !patch.hidden);
      if (soil) {
        EXPECT_EQ(world.soil_map->soils()[*soil], world_soil_name(patch.soil_class));
      }
    }
  }
}

TEST(WorldSoils, GetFirmerFromClassToClassAndOthersAreBetweenThem) {
  const sim::SoilBeliefs beliefs = world_beliefs();
  ASSERT_EQ(beliefs.known.size(), 10U);
  EXPECT_EQ(beliefs.unknown.alternatives.size(), 10U);
  EXPECT_NEAR(beliefs.known.front().mean.pressure.k_phi, 500e3, 1.0);
  EXPECT_NEAR(beliefs.known.back().mean.pressure.k_phi, 2.5e6, 10.0);
  for (std::size_t k = 1; k < beliefs.known.size(); ++k)
    EXPECT_GT(beliefs.known[k].mean.friction_angle_rad, beliefs.known[k - 1].mean.friction_angle_rad);
  for (const std::uint64_t seed : {7, 8}) {
    const sim::SoilBeliefs others = other_soils(seed);
    for (std::size_t k = 0; k < others.known.size(); ++k) {
      EXPECT_NEAR(std::abs(deg_from_rad(others.known[k].mean.friction_angle_rad -
                                        beliefs.known[k].mean.friction_angle_rad)),
                  0.5 * 7.0 / 9.0, 1e-9);
      EXPECT_NEAR(others.known[k].std.stiffness_ratio, seed % 2 == 1 ? 0.125 : 0.5, 1e-12);
    }
  }
}

}  // namespace
}  // namespace slipway::validation
