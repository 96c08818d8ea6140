#include "dem/synthetic_terrain.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "core/random.h"

namespace slipway::dem {
namespace {

std::shared_ptr<const Terrain> sampled(const SyntheticGrid& grid,
                                       const std::function<double(double x_m, double y_m)>& height_m,
                                       const std::optional<RockField>& rocks = {}) {
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
  if (rocks) add_rocks(*rocks, geometry, heights);
  std::vector<std::uint8_t> valid(heights.size(), 1);
  return std::make_shared<const Terrain>(geometry, std::move(heights), std::move(valid));
}

double ripple_m(double height_m, double width_m, double from_crest_m) {
  if (std::abs(from_crest_m) >= 0.5 * width_m) return 0.0;
  return 0.5 * height_m * (1.0 + std::cos(2.0 * std::numbers::pi * from_crest_m / width_m));
}

double bumps_m(const Relief::Roughness& roughness, double x_m, double y_m) {
  const auto node_m = [&](double column, double row) {
    // Both indices in one counter: 2^20 nodes either way are more than any grid has.
    constexpr std::int64_t kHalf = 1 << 20;
    const std::int64_t counter =
        (static_cast<std::int64_t>(row) + kHalf) * 2 * kHalf + static_cast<std::int64_t>(column) + kHalf;
    return roughness.rms_m * random_normal(roughness.seed, static_cast<std::uint64_t>(counter));
  };
  const auto smooth = [](double share) { return share * share * (3.0 - 2.0 * share); };
  const double u = x_m / roughness.lattice_m, v = y_m / roughness.lattice_m;
  const double column = std::floor(u), row = std::floor(v);
  const double east = smooth(u - column), north = smooth(v - row);
  return (1.0 - north) * ((1.0 - east) * node_m(column, row) + east * node_m(column + 1.0, row)) +
         north * ((1.0 - east) * node_m(column, row + 1.0) + east * node_m(column + 1.0, row + 1.0));
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
  return sampled(grid, [=](double x_m, double) { return ripple_m(height_m, width_m, x_m); });
}

std::shared_ptr<const Terrain> make_crater(const SyntheticGrid& grid, double radius_m, double depth_m) {
  return sampled(grid, [=](double x_m, double y_m) {
    const double r = std::hypot(x_m, y_m) / radius_m;
    return r >= 1.0 ? 0.0 : depth_m * (r * r - 1.0);
  });
}

std::shared_ptr<const Terrain> make_relief(const SyntheticGrid& grid, const Relief& relief) {
  const auto height_m = [&](double x_m, double y_m) {
    double sum_m = std::tan(relief.slope_rad) * x_m;
    if (relief.ripple)
      sum_m += ripple_m(relief.ripple->height_m, relief.ripple->width_m, x_m - relief.ripple->crest_x_m);
    if (relief.roughness) sum_m += bumps_m(*relief.roughness, x_m, y_m);
    return sum_m;
  };
  return sampled(grid, height_m, relief.rocks);
}

}  // namespace slipway::dem
