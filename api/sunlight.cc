#include "api/sunlight.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "api/departure_setting.h"

namespace slipway::api {
namespace {

constexpr double kMostSide = 256.0;    // of a picture, in cells
constexpr double kMostRays = 200'000;  // of a picture: under many suns it is coarser

// The elevation of the ground's horizon towards one azimuth from each cell's centre, row by row; empty where
// the terrain has no height.
std::vector<std::optional<double>> horizon_towards(const dem::Horizon& horizon,
                                                   const dem::GridGeometry& cells, double azimuth_rad) {
  std::vector<std::optional<double>> elevations_rad;
  elevations_rad.reserve(static_cast<std::size_t>(cells.rows) * static_cast<std::size_t>(cells.columns));
  for (int row = 0; row < cells.rows; ++row)
    for (int column = 0; column < cells.columns; ++column) {
      const Eigen::Vector2d centre = cells.centre_m({row, column});
      elevations_rad.push_back(horizon.elevation_rad(centre.x(), centre.y(), 0.0, azimuth_rad));
    }
  return elevations_rad;
}

dem::GridGeometry cells_of(const dem::Extent& extent, std::size_t suns) {
  const double width_m = extent.east_m - extent.west_m, height_m = extent.north_m - extent.south_m;
  const double side = std::min(kMostSide, std::sqrt(kMostRays / static_cast<double>(suns)));
  const auto cells = [&](double m) {
    return std::max(1, static_cast<int>(std::lround(side * m / std::max(width_m, height_m))));
  };
  const int rows = cells(height_m), columns = cells(width_m);
  return {rows, columns, extent.west_m, extent.north_m, width_m / columns, height_m / rows};
}

dem::Rgba colour_of(double share) {
  const auto* const found = std::find_if(kSunlitClasses.begin(), kSunlitClasses.end(),
                                         [&](const SunlitClass& each) { return share < each.below; });
  return found == kSunlitClasses.end() ? kSunlitClasses.back().colour : found->colour;
}

}  // namespace

Result<std::shared_ptr<const dem::Horizon>> horizon_of(const TerrainSite& site, const dem::Extent& extent) {
  constexpr double kMostCells = 512.0;  // along a side
  const dem::GridGeometry& whole = site.info().geometry;
  const dem::Extent map = whole.extent();
  dem::Extent near{std::max(extent.west_m, map.west_m), std::max(extent.south_m, map.south_m),
                   std::min(extent.east_m, map.east_m), std::min(extent.north_m, map.north_m)};
  const auto window = whole.window(near);
  const double most = window ? std::max(window->rows, window->columns) : 1.0;
  auto read = site.read_samples(window ? near : map, window ? static_cast<int>(std::ceil(most / kMostCells))
                                                            : std::max(whole.rows, whole.columns));
  if (!read) return fail(read.error());
  return horizon_over(site, std::move(*read));
}

dem::RgbaImage draw_sunlight(const dem::Horizon& horizon, const dem::Extent& extent,
                             const std::vector<sky::Bearing>& suns) {
  const auto up = static_cast<std::size_t>(std::count_if(
      suns.begin(), suns.end(), [](const sky::Bearing& sun) { return sun.elevation_rad > 0.0; }));
  const dem::GridGeometry cells = cells_of(extent, std::max<std::size_t>(1, up));
  dem::RgbaImage image(cells.rows, cells.columns);
  std::vector<int> lit(image.pixels.size(), 0);
  std::vector<std::optional<double>> horizon_rad;
  for (const sky::Bearing& sun : suns) {
    if (sun.elevation_rad <= 0.0) continue;
    horizon_rad = horizon_towards(horizon, cells, sun.azimuth_rad);
    for (std::size_t k = 0; k < lit.size(); ++k)
      lit[k] += horizon_rad[k] && sun.elevation_rad > *horizon_rad[k] ? 1 : 0;
  }
  // Where no sun is up nobody has looked for the ground yet.
  if (horizon_rad.empty()) horizon_rad = horizon_towards(horizon, cells, 0.0);
  for (std::size_t k = 0; k < lit.size(); ++k) {
    if (!horizon_rad[k]) continue;
    if (suns.size() > 1)
      image.pixels[k] = colour_of(lit[k] / static_cast<double>(suns.size()));
    else if (lit[k] == 0)
      image.pixels[k] = kShadow;
  }
  return image;
}

}  // namespace slipway::api
