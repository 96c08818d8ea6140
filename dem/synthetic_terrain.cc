#include "dem/synthetic_terrain.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

namespace slipway::dem {
namespace {

std::shared_ptr<const Terrain> sampled(const SyntheticGrid& grid,
                                       const std::function<double(double x_m, double y_m)>& height_m) {
  const int cells = std::max(1, static_cast<int>(std::lround(grid.size_m / grid.cell_m)));
  const GridGeometry geometry{.rows = cells,
                              .columns = cells,
                              .west_m = -0.5 * cells * grid.cell_m,
                              .north_m = 0.5 * cells * grid.cell_m,
                              .cell_x_m = grid.cell_m,
                              .cell_y_m = grid.cell_m};
  std::vector<float> heights;
  heights.reserve(static_cast<std::size_t>(cells) * static_cast<std::size_t>(cells));
  for (int row = 0; row < cells; ++row) {
    for (int column = 0; column < cells; ++column) {
      const Eigen::Vector2d centre = geometry.centre_m({row, column});
      heights.push_back(static_cast<float>(height_m(centre.x(), centre.y())));
    }
  }
  std::vector<std::uint8_t> valid(heights.size(), 1);
  return std::make_shared<const Terrain>(geometry, std::move(heights), std::move(valid));
}

}  // namespace

std::shared_ptr<const Terrain> make_plane(const SyntheticGrid& grid, double height_m) {
  return sampled(grid, [=](double, double) { return height_m; });
}

std::shared_ptr<const Terrain> make_ramp(const SyntheticGrid& grid, double slope_rad, double uphill_rad) {
  const double rise = std::tan(slope_rad);
  const double east = rise * std::cos(uphill_rad);
  const double north = rise * std::sin(uphill_rad);
  return sampled(grid, [=](double x_m, double y_m) { return east * x_m + north * y_m; });
}

std::shared_ptr<const Terrain> make_ripple(const SyntheticGrid& grid, double height_m, double width_m) {
  return sampled(grid, [=](double x_m, double) {
    if (std::abs(x_m) >= 0.5 * width_m) return 0.0;
    return 0.5 * height_m * (1.0 + std::cos(2.0 * std::numbers::pi * x_m / width_m));
  });
}

std::shared_ptr<const Terrain> make_crater(const SyntheticGrid& grid, double radius_m, double depth_m) {
  return sampled(grid, [=](double x_m, double y_m) {
    const double r = std::hypot(x_m, y_m) / radius_m;
    return r >= 1.0 ? 0.0 : depth_m * (r * r - 1.0);
  });
}

}  // namespace slipway::dem
