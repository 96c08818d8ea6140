#include "campaign/deformed_terrain.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace slipway::campaign {
namespace {

dem::Extent extent_of(const std::vector<sim::RutMap::Cell>& cells) {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  dem::Extent extent{.west_m = kFar, .south_m = kFar, .east_m = -kFar, .north_m = -kFar};
  for (const sim::RutMap::Cell& cell : cells) {
    extent.west_m = std::min(extent.west_m, cell.x_m);
    extent.south_m = std::min(extent.south_m, cell.y_m);
    extent.east_m = std::max(extent.east_m, cell.x_m);
    extent.north_m = std::max(extent.north_m, cell.y_m);
  }
  return extent;
}

// Edges on the ruts' own: their cells are [k, k + 1) times their size.
dem::GridGeometry grid_over(const dem::Extent& ruts, double rut_cell_m) {
  const double west_m = ruts.west_m - kDeformedMargin_m, north_m = ruts.north_m + kDeformedMargin_m;
  const double wide_m = ruts.east_m - ruts.west_m + 2.0 * kDeformedMargin_m;
  const double high_m = ruts.north_m - ruts.south_m + 2.0 * kDeformedMargin_m;
  const double fine_cells = wide_m / rut_cell_m * (high_m / rut_cell_m);
  const double multiple =
      std::max(1.0, std::ceil(std::sqrt(fine_cells / static_cast<double>(kMaxDeformedCells))));
  const double cell_m = multiple * rut_cell_m;
  return {.rows = static_cast<int>(std::ceil(high_m / cell_m)) + 1,
          .columns = static_cast<int>(std::ceil(wide_m / cell_m)) + 1,
          .west_m = std::floor(west_m / rut_cell_m) * rut_cell_m,
          .north_m = std::ceil(north_m / rut_cell_m) * rut_cell_m,
          .cell_x_m = cell_m,
          .cell_y_m = cell_m};
}

}  // namespace

std::shared_ptr<const dem::Terrain> deformed_terrain(const dem::Terrain& ground, const sim::RutMap& ruts) {
  const std::vector<sim::RutMap::Cell> cells = ruts.cells();
  if (cells.empty()) return nullptr;
  const dem::GridGeometry grid = grid_over(extent_of(cells), ruts.cell_m());
  const auto index = [&grid](const dem::Cell& cell) {
    return static_cast<std::size_t>(cell.row) * static_cast<std::size_t>(grid.columns) +
           static_cast<std::size_t>(cell.column);
  };
  std::vector<double> depth_m(static_cast<std::size_t>(grid.rows) * static_cast<std::size_t>(grid.columns));
  for (const sim::RutMap::Cell& rut : cells) {
    const std::optional<dem::Cell> cell = grid.cell_at(rut.x_m, rut.y_m);
    if (cell) depth_m[index(*cell)] = std::max(depth_m[index(*cell)], rut.depth_m);
  }
  std::vector<float> heights_m(depth_m.size());
  std::vector<std::uint8_t> valid(depth_m.size());
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      const dem::Cell cell{row, column};
      const Eigen::Vector2d centre = grid.centre_m(cell);
      const std::optional<double> height_m = ground.height_m(centre.x(), centre.y());
      valid[index(cell)] = height_m ? 1 : 0;
      heights_m[index(cell)] = static_cast<float>(height_m.value_or(0.0) - depth_m[index(cell)]);
    }
  }
  return std::make_shared<const dem::Terrain>(grid, std::move(heights_m), std::move(valid));
}

}  // namespace slipway::campaign
