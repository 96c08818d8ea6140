#include "dem/horizon/horizon.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <vector>

#include "core/angle.h"
#include "core/random.h"
#include "dem/horizon/horizon_sweep.h"
#include "dem/write/horizon_map.h"

namespace slipway::dem {
namespace {

constexpr double kFlat = std::numeric_limits<double>::infinity();

std::shared_ptr<const Terrain> sampled(const GridGeometry& grid,
                                       const std::function<double(double, double)>& height,
                                       const std::function<bool(int, int)>& missing = nullptr) {
  std::vector<float> heights;
  std::vector<std::uint8_t> valid;
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column) {
      const Eigen::Vector2d centre = grid.centre_m({row, column});
      heights.push_back(static_cast<float>(height(centre.x(), centre.y())));
      valid.push_back(missing && missing(row, column) ? 0 : 1);
    }
  return std::make_shared<const Terrain>(grid, std::move(heights), std::move(valid));
}

constexpr GridGeometry kGrid{
    .rows = 150, .columns = 130, .west_m = 0.0, .north_m = 150.0, .cell_x_m = 1.0, .cell_y_m = 1.0};

// Hills of several sizes with a wall and rough ground.
double hills(double x, double y) {
  const auto cell = static_cast<std::uint64_t>(std::lround(1000.0 * x) * 7919 + std::lround(1000.0 * y));
  return 6.0 * std::sin(0.05 * x) * std::cos(0.07 * y) + 1.5 * std::sin(0.31 * x + 0.2 * y) +
         (std::abs(x - 90.0) < 2.0 && y > 60.0 ? 9.0 : 0.0) + 0.3 * random_uniform(cell, 1);
}

// By small steps along the ray, up to the outer centres.
double marched_rad(const Terrain& terrain, double x, double y, double eye, double azimuth, double radius) {
  const double from = 0.5 * terrain.geometry().cell_x_m, ground = *terrain.height_m(x, y) + eye;
  double best = -kFlat;
  for (double d = from; d < 300.0; d += 0.02) {
    const double px = x + d * std::sin(azimuth), py = y + d * std::cos(azimuth);
    if (px < 0.5 || px > 129.5 || py < 0.5 || py > 149.5) break;
    const auto height = terrain.height_m(px, py);
    if (height) best = std::max(best, (*height - ground) / d - 0.5 * d / radius);
  }
  return std::atan(best);
}

TEST(Horizon, IsWhatSmallStepsAlongTheRayFind) {
  const auto terrain = sampled(kGrid, hills);
  for (const double radius : {kFlat, 2000.0}) {
    const Horizon horizon(terrain, radius);
    for (std::uint64_t k = 0; k < 200; ++k) {
      const double x = 2.0 + 125.0 * random_uniform(k, 0), y = 2.0 + 145.0 * random_uniform(k, 1);
      const double eye = k % 2 == 0 ? 1.0 : 0.0, azimuth = 2.0 * std::numbers::pi * random_uniform(k, 2);
      const auto found = horizon.elevation_rad(x, y, eye, azimuth);
      ASSERT_TRUE(found);
      EXPECT_NEAR(deg_from_rad(*found), deg_from_rad(marched_rad(*terrain, x, y, eye, azimuth, radius)), 0.1)
          << x << " " << y << " " << azimuth;
    }
  }
}

TEST(Horizon, OfAWallIsItsAngleAndOfTheMirroredMapTheSame) {
  const auto wall = sampled(kGrid, [](double x, double) { return x > 100.0 ? 10.0 : 0.0; });
  const auto mirrored = sampled(kGrid, [](double x, double) { return x < 30.0 ? 10.0 : 0.0; });
  const Horizon east(wall, kFlat), west(mirrored, kFlat);
  // The wall rises between the centres 99.5 and 100.5.
  const double expected = std::atan2(9.0, 40.5);
  EXPECT_NEAR(*east.elevation_rad(60.0, 70.0, 1.0, 0.5 * std::numbers::pi), expected, 1e-3);
  EXPECT_NEAR(*west.elevation_rad(70.0, 70.0, 1.0, 1.5 * std::numbers::pi), expected, 1e-3);
  EXPECT_LT(*east.elevation_rad(60.0, 70.0, 1.0, 1.5 * std::numbers::pi), 0.0);
}

// From all cells at once, in any direction, over cells that are not square, over the body's bend and by a
// finer or coarser grid of places.
TEST(HorizonSweep, IsTheHorizonOfEachPlace) {
  constexpr GridGeometry kOblong{
      .rows = 150, .columns = 90, .west_m = 7.0, .north_m = 150.0, .cell_x_m = 1.4, .cell_y_m = 1.0};
  const auto terrain = sampled(kOblong, hills, [](int row, int column) { return row == 40 && column < 30; });
  for (const double radius : {kFlat, 2000.0}) {
    const Horizon horizon(terrain, radius);
    const HorizonSweep sweep(*terrain, radius);
    for (const int every : {1, 2, 5}) {
      const GridGeometry cells = coarser_grid(kOblong, every);
      const Eyes eyes = eyes_over(*terrain, cells, 1.0);
      double square = 0.0;
      int count = 0;
      for (std::uint64_t k = 0; k < 24; ++k) {
        const double azimuth = k < 8 ? 0.25 * std::numbers::pi * static_cast<double>(k)
                                     : 2.0 * std::numbers::pi * random_uniform(k, 3);
        std::vector<float> tangents(eyes.heights_m.size(), -std::numeric_limits<float>::infinity());
        sweep.raise(eyes, azimuth, 2, tangents);
        for (std::size_t cell = 0; cell < tangents.size(); cell += 7) {
          const auto columns = static_cast<std::size_t>(cells.columns);
          const Eigen::Vector2d centre =
              cells.centre_m({static_cast<int>(cell / columns), static_cast<int>(cell % columns)});
          const auto alone = horizon.elevation_rad(centre.x(), centre.y(), 1.0, azimuth);
          ASSERT_EQ(alone.has_value(), !std::isnan(eyes.heights_m[cell]));
          // Where a ray has left the map, the lines beside it may not have.
          const bool is_on_the_rim =
              centre.x() < 10.0 || centre.x() > 130.0 || centre.y() < 3.0 || centre.y() > 147.0;
          if (!alone || is_on_the_rim) continue;
          const double off = deg_from_rad(std::abs(std::atan(double{tangents[cell]}) - *alone));
          EXPECT_LT(off, 3.0) << centre.x() << " " << centre.y() << " " << azimuth;
          square += off * off;
          ++count;
        }
      }
      // The ground is as rough as can be from cell to cell, by 0.3 m a metre.
      EXPECT_LT(std::sqrt(square / count), 0.1) << every;
    }
  }
}

// Who only asks whether the horizon is above a sun hears the same as who asks how high it is; and ground that
// is left out is passed over, but none beyond it.
TEST(HorizonSweep, ThatIsEnoughSaysTheSameOfASun) {
  const auto terrain = sampled(kGrid, hills);
  const Extent middle{40.0, 40.0, 80.0, 90.0};
  const HorizonSweep around(*terrain, kFlat, middle);
  const GridGeometry cells{
      .rows = 40, .columns = 35, .west_m = 41.0, .north_m = 89.0, .cell_x_m = 1.1, .cell_y_m = 1.2};
  const Eyes eyes = eyes_over(*terrain, cells, 0.0);
  const auto beyond = sampled(kGrid, hills, [&](int row, int column) {
    const Eigen::Vector2d at = kGrid.centre_m({row, column});
    return at.x() > middle.west_m && at.x() < middle.east_m && at.y() > middle.south_m &&
           at.y() < middle.north_m;
  });
  const HorizonSweep missing(*beyond, kFlat);
  constexpr float kNothing = -std::numeric_limits<float>::infinity();
  constexpr double kSun = 0.12;
  int dark = 0;
  for (std::uint64_t k = 0; k < 40; ++k) {
    const double azimuth = k < 8 ? 0.25 * std::numbers::pi * static_cast<double>(k)
                                 : 2.0 * std::numbers::pi * random_uniform(k, 4);
    std::vector<float> whole(eyes.heights_m.size(), kNothing), enough = whole, same = whole;
    around.raise(eyes, azimuth, 1, whole);
    around.raise(eyes, azimuth, 1, enough, kSun);
    missing.raise(eyes, azimuth, 1, same);
    EXPECT_EQ(whole, same) << azimuth;
    for (std::size_t cell = 0; cell < whole.size(); ++cell) {
      EXPECT_EQ(whole[cell] >= kSun, enough[cell] >= kSun) << azimuth;
      dark += whole[cell] >= kSun ? 1 : 0;
    }
  }
  EXPECT_GT(dark, 1000);
}

// A picture may be asked for of a hundred thousand times the map; its lines begin on the map.
TEST(HorizonSweep, PlacesOffTheMapLookNowhere) {
  const auto terrain = sampled(kGrid, hills);
  const HorizonSweep sweep(*terrain, kFlat);
  const GridGeometry wide{
      .rows = 64, .columns = 65, .west_m = -1e9, .north_m = 1e9, .cell_x_m = 3.1e7, .cell_y_m = 3.1e7};
  const Eyes eyes = eyes_over(*terrain, wide, 1.0);
  std::vector<float> tangents(eyes.heights_m.size(), -std::numeric_limits<float>::infinity());
  sweep.raise(eyes, 0.3, 1, tangents);
  for (std::size_t k = 0; k < tangents.size(); ++k) {
    if (std::isnan(eyes.heights_m[k])) {
      EXPECT_TRUE(std::isinf(tangents[k]));
    }
  }
}

TEST(Horizon, GoesOnOverTheGroundAroundTheTerrain) {
  const auto near = sampled(kGrid, [](double, double) { return 0.0; });
  constexpr GridGeometry kAround{
      .rows = 60, .columns = 60, .west_m = -500.0, .north_m = 700.0, .cell_x_m = 20.0, .cell_y_m = 20.0};
  const auto far = sampled(kAround, [](double x, double) { return x > 400.0 ? 100.0 : 0.0; });
  const Horizon horizon(near, kFlat, far);
  EXPECT_NEAR(*horizon.elevation_rad(60.0, 70.0, 0.0, 0.5 * std::numbers::pi), std::atan2(100.0, 350.0),
              5e-3);
  EXPECT_NEAR(*Horizon(near, kFlat).elevation_rad(60.0, 70.0, 0.0, 0.5 * std::numbers::pi), 0.0, 1e-6);
}

TEST(Horizon, HasNothingWhereTheGroundHasNone) {
  const auto terrain = sampled(
      kGrid, [](double, double) { return 0.0; },
      [](int row, int column) { return row == 80 && column > 50; });
  const Horizon horizon(terrain, kFlat);
  EXPECT_FALSE(horizon.elevation_rad(80.0, 150.0 - 80.5, 1.0, 0.0));
  EXPECT_TRUE(horizon.all_around_rad(20.0, 20.0, 1.0, 72));
}

TEST(Horizon, BetweenDirectionsIsLinearAndGoesRound) {
  const std::vector<double> four{0.0, 1.0, 2.0, 4.0};
  EXPECT_DOUBLE_EQ(horizon_between_rad(four, 0.25 * std::numbers::pi), 0.5);
  EXPECT_DOUBLE_EQ(horizon_between_rad(four, 1.75 * std::numbers::pi), 2.0);
}

}  // namespace
}  // namespace slipway::dem
