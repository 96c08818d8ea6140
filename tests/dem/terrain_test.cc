#include "dem/terrain.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include "core/angle.h"

namespace slipway::dem {
namespace {

constexpr GridGeometry kGrid{
    .rows = 12, .columns = 9, .west_m = -40.0, .north_m = 70.0, .cell_x_m = 0.5, .cell_y_m = 0.25};

Terrain sampled(const std::function<double(double, double)>& height,
                const std::vector<std::size_t>& masked = {}, const GridGeometry& grid = kGrid) {
  std::vector<float> heights;
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      const Eigen::Vector2d centre = grid.centre_m({row, column});
      heights.push_back(static_cast<float>(height(centre.x(), centre.y())));
    }
  }
  std::vector<std::uint8_t> valid(heights.size(), 1);
  for (const std::size_t i : masked) {
    valid[i] = 0;
    heights[i] = std::numeric_limits<float>::quiet_NaN();
  }
  return Terrain(grid, std::move(heights), std::move(valid));
}

std::size_t index_of(int row, int column) {
  return static_cast<std::size_t>(row) * static_cast<std::size_t>(kGrid.columns) +
         static_cast<std::size_t>(column);
}

TEST(TerrainHeight, ABilinearFunctionIsReproducedExactlyBetweenTheCentres) {
  // Coefficients and places whose products are exact in floats.
  const auto truth = [](double x, double y) {
    return 2.0 + 0.5 * (x + 40.0) - 0.25 * (y - 67.0) + (x + 40.0) * (y - 67.0);
  };
  const Terrain terrain = sampled(truth);
  for (int i = 0; i <= 128; ++i) {
    for (int j = 0; j <= 44; ++j) {
      const double x = -39.75 + 0.03125 * i;
      const double y = 67.125 + 0.0625 * j;
      ASSERT_DOUBLE_EQ(*terrain.height_m(x, y), truth(x, y)) << x << " " << y;
    }
  }
}

TEST(TerrainHeight, WithinHalfACellOfTheOuterEdgeTheEdgeCentreIsExtended) {
  const Terrain terrain = sampled([](double x, double) { return x; });
  EXPECT_DOUBLE_EQ(*terrain.height_m(-40.0, 69.0), -39.75);
  EXPECT_DOUBLE_EQ(*terrain.height_m(-35.5, 69.0), -35.75);
  EXPECT_FALSE(terrain.height_m(-40.001, 69.0));
  EXPECT_FALSE(terrain.height_m(-38.0, 70.001));
}

class PlaneTowards : public testing::TestWithParam<int> {};

TEST_P(PlaneTowards, SlopeAspectAndNormalAreThoseOfThePlane) {
  const double uphill = GetParam() * std::numbers::pi / 4.0;  // counter-clockwise from east
  const double slope = rad_from_deg(17.0);
  const double rise = std::tan(slope);
  const Terrain terrain = sampled([&](double x, double y) {
    return rise * (std::cos(uphill) * (x + 38.0) + std::sin(uphill) * (y - 68.0));
  });
  const Eigen::Vector3d normal(-std::sin(slope) * std::cos(uphill), -std::sin(slope) * std::sin(uphill),
                               std::cos(slope));
  // Downhill is opposite to uphill; compass angles run the other way from north.
  const double downhill_compass = std::numbers::pi / 2.0 - (uphill + std::numbers::pi);
  for (const auto& [x, y] : {std::pair{-37.9, 68.4}, {-40.0, 70.0}, {-35.5, 67.0}}) {
    const auto point = terrain.surface(x, y);
    ASSERT_TRUE(point);
    EXPECT_NEAR((point->normal - normal).norm(), 0.0, 1e-6);
    EXPECT_NEAR(point->normal.norm(), 1.0, 1e-14);
    EXPECT_NEAR(point->slope_rad(), slope, 1e-6);
    EXPECT_NEAR(wrapped_rad(point->aspect_rad() - downhill_compass), 0.0, 3e-6);
    EXPECT_GE(point->aspect_rad(), 0.0);
    EXPECT_LT(point->aspect_rad(), 2.0 * std::numbers::pi);
  }
}

INSTANTIATE_TEST_SUITE_P(EightDirections, PlaneTowards, testing::Range(0, 8));

TEST(TerrainSurface, LevelGroundHasNoSlopeAndAspectZero) {
  const auto point = sampled([](double, double) { return 5.0; }).surface(-38.0, 68.0);
  ASSERT_TRUE(point);
  EXPECT_EQ(point->slope_rad(), 0.0);
  EXPECT_EQ(point->aspect_rad(), 0.0);
  EXPECT_EQ(point->height_m, 5.0);
}

TEST(TerrainSurface, TheNormalIsContinuousAcrossCellBorders) {
  const Terrain terrain = sampled([](double x, double y) { return std::sin(3.0 * x) * std::cos(4.0 * y); });
  for (int i = 0; i < 12; ++i) {
    const double x = -39.0 + 0.25 * i;  // centres and cell borders
    const Eigen::Vector3d before = terrain.surface(x - 1e-9, 68.3)->normal;
    const Eigen::Vector3d after = terrain.surface(x + 1e-9, 68.3)->normal;
    EXPECT_LT((before - after).norm(), 1e-7) << x;
  }
}

TEST(TerrainMask, APointThatNeedsAMaskedCellHasNoHeight) {
  const Terrain terrain = sampled([](double x, double) { return x; }, {index_of(5, 4)});
  const Eigen::Vector2d masked = kGrid.centre_m({5, 4});
  EXPECT_FALSE(terrain.has_data({5, 4}));
  EXPECT_FALSE(terrain.height_m(Cell{5, 4}));
  EXPECT_FALSE(terrain.height_m(masked.x(), masked.y()));
  EXPECT_FALSE(terrain.height_m(masked.x() + 0.3, masked.y()));
  EXPECT_FALSE(terrain.surface(masked.x() + 0.3, masked.y()));
  EXPECT_TRUE(terrain.height_m(masked.x() + 0.51, masked.y()));
}

TEST(TerrainMask, AtTheCentreBesideAMaskedCellTheHeightIsTheCellsOwn) {
  const Terrain terrain = sampled([](double x, double) { return x; }, {index_of(5, 4)});
  const Eigen::Vector2d beside = kGrid.centre_m({5, 5});
  EXPECT_DOUBLE_EQ(*terrain.height_m(beside.x() - 1e-9, beside.y()), beside.x());
}

TEST(TerrainMask, BesideAMaskedNeighbourTheDifferenceIsOneSidedAndAPlaneKeepsItsSlope) {
  const Terrain terrain = sampled([](double x, double y) { return 0.5 * x - 0.25 * y; }, {index_of(5, 4)});
  const auto point = terrain.surface(Cell{5, 5});
  ASSERT_TRUE(point);
  EXPECT_NEAR(point->normal.x() / point->normal.z(), -0.5, 1e-6);
  EXPECT_NEAR(point->normal.y() / point->normal.z(), 0.25, 1e-6);
}

TEST(TerrainMask, ACellBetweenTwoMaskedOnesHasAHeightButNoSlope) {
  const Terrain terrain = sampled([](double x, double) { return x; }, {index_of(5, 3), index_of(5, 5)});
  EXPECT_TRUE(terrain.height_m(Cell{5, 4}));
  EXPECT_FALSE(terrain.surface(Cell{5, 4}));
}

TEST(TerrainRoughness, APlaneHasNone) {
  const Terrain terrain = sampled([](double x, double y) { return 0.75 * x - 0.5 * y; });
  EXPECT_NEAR(*terrain.roughness_m(-38.0, 68.5, 1.0), 0.0, 2e-6);
}

TEST(TerrainRoughness, ACheckerboardHasItsAmplitude) {
  // 8 x 8 centres around the middle: as many up as down in every row and column, so the plane stays level.
  const GridGeometry grid{
      .rows = 8, .columns = 8, .west_m = -4.0, .north_m = 4.0, .cell_x_m = 1.0, .cell_y_m = 1.0};
  const Terrain terrain = sampled(
      [](double x, double y) {
        return (static_cast<int>(std::floor(x)) + static_cast<int>(std::floor(y))) % 2 == 0 ? 0.125 : -0.125;
      },
      {}, grid);
  // Within radius 6 all 64 centres take part. In closed form the mean square is a^2 less the part that the
  // two fitted slopes explain, which is 0.
  EXPECT_NEAR(*terrain.roughness_m(0.0, 0.0, 6.0), 0.125, 1e-9);
}

TEST(TerrainRoughness, ItIsTheDistanceFromTheSlopingPlaneNotTheVerticalOne) {
  const GridGeometry grid{
      .rows = 8, .columns = 8, .west_m = -4.0, .north_m = 4.0, .cell_x_m = 1.0, .cell_y_m = 1.0};
  const Terrain terrain = sampled(
      [](double x, double y) {
        return y + ((static_cast<int>(std::floor(x)) + static_cast<int>(std::floor(y))) % 2 == 0 ? 0.125
                                                                                                 : -0.125);
      },
      {}, grid);
  EXPECT_NEAR(*terrain.roughness_m(0.0, 0.0, 6.0), 0.125 * std::cos(rad_from_deg(45.0)), 1e-9);
}

TEST(TerrainRoughness, WithFewerThanFourCentresThereIsNone) {
  const Terrain terrain = sampled([](double, double) { return 0.0; });
  EXPECT_FALSE(terrain.roughness_m(-38.0, 68.5, 0.1));
  EXPECT_FALSE(terrain.roughness_m(500.0, 500.0, 1.0));
}

TEST(TerrainFingerprint, ItChangesWithAHeightTheMaskAndTheGeometryOnly) {
  const auto plane = [](double x, double y) { return x + y; };
  const std::string whole = sampled(plane).fingerprint();
  EXPECT_EQ(whole.size(), 16U);
  EXPECT_EQ(whole, sampled(plane).fingerprint());
  EXPECT_NE(whole, sampled(plane, {7}).fingerprint());
  EXPECT_NE(whole,
            sampled([](double x, double y) { return x + y + (x > -36.0 ? 1e-3 : 0.0); }).fingerprint());
  // Heights of masked cells are never read.
  const GridGeometry two{.rows = 1, .columns = 2};
  EXPECT_EQ(Terrain(two, {1.0F, 2.0F}, {1, 0}).fingerprint(),
            Terrain(two, {1.0F, 9.0F}, {1, 0}).fingerprint());
  GridGeometry moved = two;
  moved.west_m = 1.0;
  EXPECT_NE(Terrain(two, {1.0F, 2.0F}, {1, 1}).fingerprint(),
            Terrain(moved, {1.0F, 2.0F}, {1, 1}).fingerprint());
}

TEST(Terrain, WrongSizesAndHeightsThatAreNotFiniteThrow) {
  const GridGeometry two{.rows = 1, .columns = 2};
  EXPECT_THROW(Terrain(two, {1.0F}, {1, 1}), std::invalid_argument);
  EXPECT_THROW(Terrain(two, {1.0F, 2.0F}, {1}), std::invalid_argument);
  EXPECT_THROW(Terrain(GridGeometry{}, {}, {}), std::invalid_argument);
  EXPECT_THROW(Terrain(two, {1.0F, std::nanf("")}, {1, 1}), std::invalid_argument);
}

// Counts what is asked for. Rows from 900 on can't be read.
class WavyCells final : public CellReader {
 public:
  static float height(int row, int column) {
    return static_cast<float>(std::sin(0.01 * row) + 0.02 * column);
  }
  static bool is_missing(int row, int column) { return row == 300 && column == 700; }
  Result<void> read(const CellWindow& window, float* heights_m, std::uint8_t* valid) const override {
    read_ += static_cast<long long>(window.rows) * window.columns;
    if (window.row >= 896) return fail(ErrorCode::kUnreadableRaster, "made so");
    for (int r = 0; r < window.rows; ++r) {
      for (int c = 0; c < window.columns; ++c) {
        const bool missing = is_missing(window.row + r, window.column + c);
        *valid++ = missing ? 0 : 1;
        *heights_m++ = missing ? 0.0F : height(window.row + r, window.column + c);
      }
    }
    return {};
  }
  mutable long long read_ = 0;
};

TEST(TerrainReadByTiles, IsTheSameAsOneThatIsHeldAndReadsWhatIsLookedAt) {
  const GridGeometry g{1000, 1400, 0.0, 1000.0, 1.0, 1.0};
  const auto cells = std::make_shared<const WavyCells>();
  const Terrain tiles(g, cells);
  EXPECT_TRUE(tiles.is_read_by_tiles());
  EXPECT_EQ(cells->read_, 0);
  std::vector<float> heights(1000 * 1400);
  std::vector<std::uint8_t> valid(heights.size());
  ASSERT_TRUE(cells->read({0, 0, 896, 1400}, heights.data(), valid.data()));
  cells->read_ = 0;
  const Terrain held(g, heights, valid);
  int compared = 0;
  for (double y = 880.0; y > 560.0; y -= 13.7) {
    for (double x = 505.0; x < 1020.0; x += 11.3) {
      EXPECT_EQ(tiles.height_m(x, y), held.height_m(x, y));
      const auto a = tiles.surface(x, y), b = held.surface(x, y);
      ASSERT_EQ(a.has_value(), b.has_value());
      if (a) {
        EXPECT_EQ(a->normal, b->normal);
      }
      EXPECT_EQ(tiles.roughness_m(x, y, 3.0), held.roughness_m(x, y, 3.0));
      ++compared;
    }
  }
  EXPECT_GT(compared, 500);
  EXPECT_FALSE(tiles.has_data({300, 700}));
  EXPECT_EQ(tiles.heights_in({299, 699, 3, 3}), nullptr);
  ASSERT_NE(tiles.heights_in({400, 500, 3, 3}), nullptr);
  EXPECT_EQ(*tiles.heights_in({400, 500, 3, 3}), WavyCells::height(400, 500));
  EXPECT_LT(cells->read_, 1000 * 1400 / 2);
  const long long before = cells->read_;
  const auto part = tiles.part({100, 100, 20, 30});
  ASSERT_TRUE(part);
  EXPECT_EQ(part->height_m(Cell{3, 4}), held.height_m(Cell{103, 104}));
  EXPECT_EQ(cells->read_, before + 20 * 30) << "a part is read without being kept";
}

TEST(TerrainReadByTiles, SaysThatATileCouldNotBeReadAndHasNoDataThere) {
  const Terrain tiles({1000, 1400, 0.0, 1000.0, 1.0, 1.0}, std::make_shared<const WavyCells>());
  EXPECT_FALSE(tiles.damage());
  EXPECT_FALSE(tiles.has_data({950, 10}));
  ASSERT_TRUE(tiles.damage());
  EXPECT_EQ(tiles.damage()->code, ErrorCode::kUnreadableRaster);
  EXPECT_EQ(tiles.part({950, 0, 2, 2}), nullptr);
}

// A search over any distance reads parts alone where it looks over the whole map.
TEST(TerrainReadByTiles, SaysThatAPartCouldNotBeRead) {
  const Terrain tiles({1000, 1400, 0.0, 1000.0, 1.0, 1.0}, std::make_shared<const WavyCells>());
  EXPECT_TRUE(tiles.part({100, 0, 2, 2}));
  EXPECT_FALSE(tiles.damage());
  EXPECT_EQ(tiles.part({950, 0, 2, 2}), nullptr);
  ASSERT_TRUE(tiles.damage());
  EXPECT_EQ(tiles.damage()->code, ErrorCode::kUnreadableRaster);
}

}  // namespace
}  // namespace slipway::dem
