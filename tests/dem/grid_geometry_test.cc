#include "dem/grid_geometry.h"

#include <gtest/gtest.h>

#include <limits>

namespace slipway::dem {
namespace {

// Neither square nor symmetric, so that no exchange of rows and columns goes unseen.
constexpr GridGeometry kGrid{
    .rows = 4, .columns = 5, .west_m = 100.0, .north_m = 200.0, .cell_x_m = 2.0, .cell_y_m = 3.0};

TEST(GridGeometry, TheCentreOfTheNorthWestCellIsHalfACellInsideTheCorner) {
  EXPECT_EQ(kGrid.centre_m({0, 0}), Eigen::Vector2d(101.0, 198.5));
  EXPECT_EQ(kGrid.centre_m({3, 4}), Eigen::Vector2d(109.0, 189.5));
}

TEST(GridGeometry, ItsExtentIsItsOuterEdges) {
  EXPECT_EQ(kGrid.extent(), (Extent{.west_m = 100.0, .south_m = 188.0, .east_m = 110.0, .north_m = 200.0}));
}

TEST(GridGeometry, FractionalIndicesAreWholeAtCentresAndMinusAHalfAtTheOuterCorner) {
  EXPECT_EQ(kGrid.fractional_index(100.0, 200.0), Eigen::Vector2d(-0.5, -0.5));
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 5; ++column) {
      const Eigen::Vector2d centre = kGrid.centre_m({row, column});
      EXPECT_EQ(kGrid.fractional_index(centre.x(), centre.y()), Eigen::Vector2d(row, column));
      EXPECT_EQ(kGrid.cell_at(centre.x(), centre.y()), (Cell{row, column}));
    }
  }
}

TEST(GridGeometry, APointOnTheSouthEastEdgeBelongsToTheLastCell) {
  EXPECT_EQ(kGrid.cell_at(110.0, 188.0), (Cell{3, 4}));
  EXPECT_EQ(kGrid.cell_at(102.0, 197.0), (Cell{1, 1}));  // an inner edge belongs to the cell after it
}

TEST(GridGeometry, APointOutsideHasNoCell) {
  EXPECT_FALSE(kGrid.cell_at(99.99, 195.0));
  EXPECT_FALSE(kGrid.cell_at(110.01, 195.0));
  EXPECT_FALSE(kGrid.cell_at(105.0, 200.01));
  EXPECT_FALSE(kGrid.cell_at(105.0, 187.99));
  EXPECT_FALSE(kGrid.cell_at(std::numeric_limits<double>::quiet_NaN(), 195.0));
}

TEST(GridGeometry, AWindowIsTheCellsWhoseAreaMeetsTheExtent) {
  EXPECT_EQ(kGrid.window({.west_m = 103.0, .south_m = 192.0, .east_m = 104.5, .north_m = 196.0}),
            (CellWindow{.row = 1, .column = 1, .rows = 2, .columns = 2}));
  EXPECT_EQ(kGrid.window({.west_m = -1e300, .south_m = -1e300, .east_m = 1e300, .north_m = 1e300}),
            (CellWindow{.row = 0, .column = 0, .rows = 4, .columns = 5}));
}

TEST(GridGeometry, AnExtentThatOnlyTouchesTheRasterHasNoWindow) {
  EXPECT_FALSE(kGrid.window({.west_m = 110.0, .south_m = 188.0, .east_m = 120.0, .north_m = 200.0}));
  EXPECT_FALSE(kGrid.window({.west_m = 90.0, .south_m = 188.0, .east_m = 100.0, .north_m = 200.0}));
  EXPECT_FALSE(kGrid.window({.west_m = 100.0, .south_m = 200.0, .east_m = 110.0, .north_m = 210.0}));
}

TEST(GridGeometry, AnExtentThatIsInvertedOrNotANumberHasNoWindow) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(kGrid.window({.west_m = 106.0, .south_m = 190.0, .east_m = 104.0, .north_m = 195.0}));
  EXPECT_FALSE(kGrid.window({.west_m = nan, .south_m = 190.0, .east_m = 104.0, .north_m = 195.0}));
  EXPECT_FALSE(kGrid.window({.west_m = 104.0, .south_m = 190.0, .east_m = 106.0, .north_m = nan}));
}

TEST(GridGeometry, APointIsAWindowOfTheOneCellThatHoldsIt) {
  for (const auto& [x, y] : {std::pair{105.0, 195.0}, {104.0, 194.0}, {110.0, 188.0}, {100.0, 200.0}}) {
    const auto window = kGrid.window({.west_m = x, .south_m = y, .east_m = x, .north_m = y});
    ASSERT_TRUE(window);
    EXPECT_EQ((Cell{window->row, window->column}), kGrid.cell_at(x, y));
    EXPECT_EQ(window->rows * window->columns, 1);
  }
}

TEST(GridGeometry, TheWindowOfAPartsExtentIsThatPartInSpiteOfRounding) {
  const GridGeometry far{.rows = 4000,
                         .columns = 5000,
                         .west_m = 8142406.3,
                         .north_m = -276455.7,
                         .cell_x_m = 0.1,
                         .cell_y_m = 0.3};
  for (int k = 0; k < 3000; k += 7) {
    const CellWindow part{.row = k, .column = k + 1, .rows = 11, .columns = 17};
    ASSERT_EQ(far.window(far.sub(part).extent()), part) << k;
  }
}

}  // namespace
}  // namespace slipway::dem
