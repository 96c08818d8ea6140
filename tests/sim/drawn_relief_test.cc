#include "sim/prediction/drawn_relief.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/random.h"
#include "sim/rover/stance.h"
#include "tests/sim/reference_models.h"

namespace slipway::sim {
namespace {

const FunctionGround kLevel([](double, double) { return 0.0; });

TEST(DrawnRelief, WithoutSpreadIsTheGroundItself) {
  const FunctionGround hills([](double x, double y) { return 0.3 * std::sin(x) * std::cos(0.7 * y); });
  const DrawnRelief drawn(hills, {}, 7);
  for (int k = 0; k < 50; ++k) {
    EXPECT_DOUBLE_EQ(drawn.at(0.3 * k, 1.0)->height_m, hills.at(0.3 * k, 1.0)->height_m);
    EXPECT_LT((drawn.at(0.3 * k, 1.0)->normal - hills.at(0.3 * k, 1.0)->normal).norm(), 1e-12);
  }
}

TEST(DrawnRelief, HeightsHaveTheDeviationThatIsAskedForAtEveryPlace) {
  for (const double place : {0.0, 1.3, 2.5}) {  // at a corner of the lattice, off it and in its middle
    double squares = 0.0;
    constexpr int kDraws = 4000;
    for (std::uint64_t key = 0; key < kDraws; ++key) {
      const DrawnRelief drawn(kLevel, {.elevation_error_m = 0.2, .error_length_m = 5.0}, random_key(3, key));
      const double height = drawn.at(place, place)->height_m;
      squares += height * height / kDraws;
    }
    EXPECT_NEAR(std::sqrt(squares), 0.2, 0.01) << place;
  }
}

TEST(DrawnRelief, NormalsAreThoseOfTheHeights) {
  const ReliefSpread spread{.elevation_error_m = 0.2, .roughness_m = 0.02, .rock_share = 0.2};
  const DrawnRelief drawn(kLevel, spread, 11);
  constexpr double h = 1e-6;
  int rough = 0;
  for (int k = 0; k < 400; ++k) {
    const double x = 0.1 * k + 0.013, y = 0.07 * k;
    const auto here = drawn.at(x, y);
    const double by_x = (drawn.at(x + h, y)->height_m - drawn.at(x - h, y)->height_m) / (2.0 * h);
    const double by_y = (drawn.at(x, y + h)->height_m - drawn.at(x, y - h)->height_m) / (2.0 * h);
    EXPECT_LT((here->normal - Eigen::Vector3d(-by_x, -by_y, 1.0).normalized()).norm(), 1e-4) << k;
    rough += here->normal.z() < 0.9 ? 1 : 0;
  }
  EXPECT_GT(rough, 5) << "no rock was met";
}

// The area under rocks is k (e^(-q D) from the least to the greatest width), by which the model is defined.
TEST(DrawnRelief, RocksCoverTheAreaThatTheModelGives) {
  const ReliefSpread spread{.rock_share = 0.1, .min_rock_m = 0.1, .max_rock_m = 0.6};
  const double q = 1.79 + 0.152 / 0.1;
  const double wanted = 0.1 * (std::exp(-q * 0.1) - std::exp(-q * 0.6));
  const DrawnRelief drawn(kLevel, spread, 5);
  int covered = 0, all = 0;
  for (double x = 0.0; x < 60.0; x += 0.1)
    for (double y = 0.0; y < 60.0; y += 0.1) {
      covered += drawn.at(x, y)->height_m > 0.0 ? 1 : 0;
      ++all;
    }
  // Rocks that lie on each other cover less than their sum: 1 - e^(-wanted).
  EXPECT_NEAR(static_cast<double>(covered) / all, 1.0 - std::exp(-wanted), 0.1 * wanted);
  EXPECT_GT(rocks_per_m2(spread, 0.1), rocks_per_m2(spread, 0.3));
  EXPECT_EQ(rocks_per_m2({}, 0.1), 0.0);
}

TEST(DrawnRelief, RocksLieAsCloseAsTheirPlaceSays) {
  const auto covered = [](const DrawnRelief& drawn, double from_x) {
    int count = 0;
    for (double x = from_x; x < from_x + 40.0; x += 0.1)
      for (double y = 0.0; y < 40.0; y += 0.1) count += drawn.at(x, y)->height_m > 0.0 ? 1 : 0;
    return count / 160000.0;
  };
  ReliefSpread spread{.rock_share = 0.2};
  spread.rock_share_at = [](double x, double) { return x < 0.0 ? 0.0 : x < 100.0 ? 0.05 : 0.2; };
  const DrawnRelief drawn(kLevel, spread, 5);
  const DrawnRelief everywhere(kLevel, {.rock_share = 0.05}, 6);
  EXPECT_EQ(covered(drawn, -60.0), 0.0);
  const double alone = covered(everywhere, 20.0);
  EXPECT_NEAR(covered(drawn, 20.0), alone, 0.15 * alone);
  EXPECT_GT(covered(drawn, 120.0), 2.0 * alone);
}

TEST(DrawnRelief, MoreSpreadTiltsARoverOnLevelGroundMore) {
  const RoverModel rover = six_wheeler();
  const auto rms_tilt = [&](const ReliefSpread& spread) {
    double squares = 0.0;
    int count = 0;
    for (std::uint64_t key = 0; key < 200; ++key) {
      const DrawnRelief drawn(kLevel, spread, random_key(9, key));
      const auto stance = settle(rover, drawn, {3.0, 4.0, 0.3});
      if (!stance) continue;
      squares += stance->attitude.tilt_rad() * stance->attitude.tilt_rad();
      ++count;
    }
    EXPECT_GT(count, 190);
    return std::sqrt(squares / count);
  };
  const double none = rms_tilt({}), error = rms_tilt({.elevation_error_m = 0.1}),
               both = rms_tilt({.elevation_error_m = 0.1, .rock_share = 0.2});
  EXPECT_LT(none, 1e-9);
  EXPECT_GT(error, 0.01);
  EXPECT_GT(both, error);
}

}  // namespace
}  // namespace slipway::sim
