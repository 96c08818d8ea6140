#include "dem/gradient_field.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/angle.h"
#include "dem/write/hillshade.h"

namespace slipway::dem {
namespace {

constexpr GridGeometry kGeometry{
    .rows = 12, .columns = 17, .west_m = 8e6, .north_m = -3e5, .cell_x_m = 2.0, .cell_y_m = 1.5};

Terrain hills(std::vector<std::uint8_t> valid) {
  std::vector<float> heights;
  for (int row = 0; row < kGeometry.rows; ++row)
    for (int column = 0; column < kGeometry.columns; ++column)
      heights.push_back(-4000.0F + static_cast<float>(std::sin(0.7 * row) * std::cos(0.4 * column)));
  return {kGeometry, std::move(heights), std::move(valid)};
}

std::vector<std::uint8_t> all_cells() {
  return std::vector<std::uint8_t>(static_cast<std::size_t>(kGeometry.rows * kGeometry.columns), 1);
}

// To the outer edges, where the edge's centres are extended and differences are one-sided.
TEST(GradientField, HasTheSurfaceOfTheTerrainAtEveryPlace) {
  const Terrain terrain = hills(all_cells());
  const auto field = GradientField::of(terrain);
  ASSERT_TRUE(field);
  const Eigen::Vector3d sun = towards_sun(rad_from_deg(315.0), rad_from_deg(40.0));
  const Extent map = kGeometry.extent();
  constexpr int kSteps = 97;
  for (int i = 0; i <= kSteps; ++i) {
    for (int j = 0; j <= kSteps; ++j) {
      const double x = map.west_m + (map.east_m - map.west_m) * j / kSteps;
      const double y = map.south_m + (map.north_m - map.south_m) * i / kSteps;
      const auto surface = terrain.surface(x, y);
      ASSERT_TRUE(surface);
      const BetweenCentres row = field->row_at(y), column = field->column_at(x);
      ASSERT_TRUE(row.inside && column.inside);
      const Eigen::Vector2f rise = field->at(row, column);
      EXPECT_NEAR(rise.x(), -surface->normal.x() / surface->normal.z(), 1e-5);
      EXPECT_NEAR(rise.y(), -surface->normal.y() / surface->normal.z(), 1e-5);
      EXPECT_NEAR(light_on_gradient(rise, sun, 1.5F), light_on(surface->normal, sun, 1.5), 1e-5);
    }
  }
  EXPECT_FALSE(field->column_at(map.west_m - 0.1).inside);
  EXPECT_FALSE(field->row_at(map.north_m + 0.1).inside);
}

TEST(GradientField, IsThereOnlyWhereEveryCellHasDataAndNeighbours) {
  std::vector<std::uint8_t> gap = all_cells();
  gap[40] = 0;
  EXPECT_FALSE(GradientField::of(hills(gap)));
  EXPECT_FALSE(GradientField::of(Terrain({.rows = 1, .columns = 3}, {1.0F, 2.0F, 3.0F}, {1, 1, 1})));
}

}  // namespace
}  // namespace slipway::dem
