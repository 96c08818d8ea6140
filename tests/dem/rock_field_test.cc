#include "dem/rock_field.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "dem/synthetic_terrain.h"

namespace slipway::dem {
namespace {

const RockField kField{
    .cover_share = 0.15, .smallest_m = 0.1, .largest_m = 1.0, .height_share = 0.4, .seed = 3};

double area_m2(const Rock& rock) {
  return 0.25 * std::numbers::pi * rock.diameter_m * rock.diameter_m;
}

TEST(RockField, CoversTheShareOfGolombekAndRappWithinSamplingError) {
  // q = 1.79 + 0.152 / 0.15 = 2.8033
  EXPECT_NEAR(covered_share(kField), 0.15 * (std::exp(-0.28033) - std::exp(-2.8033)), 1e-5);
  const SyntheticGrid grid{.size_m = 60.0, .cell_m = 0.05};
  const auto ground = make_relief(grid, {.rocks = kField});
  const GridGeometry& geometry = ground->geometry();
  long covered = 0;
  for (int row = 0; row < geometry.rows; ++row)
    for (int column = 0; column < geometry.columns; ++column)
      covered += *ground->height_m(Cell{row, column}) > 0.0 ? 1 : 0;
  const double share = static_cast<double>(covered) / geometry.rows / geometry.columns;
  double squares_m4 = 0.0;
  for (const Rock& rock : rocks_in(kField, geometry.extent())) squares_m4 += std::pow(area_m2(rock), 2);
  const double error = std::sqrt(squares_m4) / (grid.size_m * grid.size_m);
  EXPECT_LT(error, 0.03 * covered_share(kField));
  EXPECT_NEAR(share, covered_share(kField), 3.0 * error);
}

TEST(RockField, SizesAreDistributedExponentiallyByArea) {
  double whole_m2 = 0.0, squares_m4 = 0.0;
  const std::vector<Rock> rocks = rocks_in(kField, {-50.0, -50.0, 50.0, 50.0});
  for (const Rock& rock : rocks) {
    EXPECT_GE(rock.diameter_m, 0.1);
    EXPECT_LE(rock.diameter_m, 1.0);
    whole_m2 += area_m2(rock);
    squares_m4 += std::pow(area_m2(rock), 2);
  }
  const auto f = [](double diameter_m) { return std::exp(-(1.79 + 0.152 / 0.15) * diameter_m); };
  for (const double least_m : {0.2, 0.3, 0.5, 0.8}) {
    double larger_m2 = 0.0;
    for (const Rock& rock : rocks) larger_m2 += rock.diameter_m >= least_m ? area_m2(rock) : 0.0;
    EXPECT_NEAR(larger_m2 / whole_m2, (f(least_m) - f(1.0)) / (f(0.1) - f(1.0)),
                3.0 * std::sqrt(squares_m4) / whole_m2)
        << least_m;
  }
}

TEST(RockField, ARockIsHalfAnEllipsoid) {
  const RockField few{.cover_share = 0.02, .smallest_m = 0.5, .largest_m = 0.6, .height_share = 0.3};
  const GridGeometry fine{
      .rows = 2000, .columns = 2000, .west_m = 0.0, .north_m = 40.0, .cell_x_m = 0.02, .cell_y_m = 0.02};
  std::vector<float> heights(4'000'000, 7.0F);
  add_rocks(few, fine, heights);
  const std::vector<Rock> rocks = rocks_in(few, fine.extent());
  ASSERT_FALSE(rocks.empty());
  int alone = 0;
  for (const Rock& rock : rocks) {
    const bool overlapped = std::any_of(rocks.begin(), rocks.end(), [&](const Rock& other) {
      const double apart_m = std::hypot(other.x_m - rock.x_m, other.y_m - rock.y_m);
      return apart_m > 0.0 && apart_m < 0.6;
    });
    const auto cell = fine.cell_at(rock.x_m + 0.3 * rock.diameter_m, rock.y_m);
    if (overlapped || !cell) continue;
    ++alone;
    const Eigen::Vector2d off = fine.centre_m(*cell) - Eigen::Vector2d(rock.x_m, rock.y_m);
    const double from = off.norm() / (0.5 * rock.diameter_m);
    EXPECT_NEAR(heights[static_cast<std::size_t>(cell->row) * 2000 + static_cast<std::size_t>(cell->column)],
                7.0 + 0.3 * rock.diameter_m * std::sqrt(1.0 - from * from), 1e-5);
  }
  EXPECT_GT(alone, 0);
}

TEST(RockField, TheSameSeedGivesTheSameRocksWhateverIsAskedFor) {
  const SyntheticGrid small{.size_m = 10.0, .cell_m = 0.1}, large{.size_m = 20.0, .cell_m = 0.1};
  const auto ground = make_relief(small, {.slope_rad = 0.1, .rocks = kField});
  EXPECT_EQ(ground->fingerprint(), make_relief(small, {.slope_rad = 0.1, .rocks = kField})->fingerprint());
  RockField other = kField;
  other.seed = 4;
  EXPECT_NE(ground->fingerprint(), make_relief(small, {.slope_rad = 0.1, .rocks = other})->fingerprint());
  const auto wider = make_relief(large, {.slope_rad = 0.1, .rocks = kField});
  for (int row = 0; row < 100; ++row)
    for (int column = 0; column < 100; ++column)
      ASSERT_NEAR(*ground->height_m(Cell{row, column}), *wider->height_m(Cell{row + 50, column + 50}), 1e-6);
}

}  // namespace
}  // namespace slipway::dem
