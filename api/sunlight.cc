#include "api/sunlight.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "api/departure_setting.h"

namespace slipway::api {
namespace {

// So that many suns cost little more than a few, they are drawn in fewer cells.
dem::GridGeometry cells_of(const dem::Extent& extent, std::size_t suns) {
  constexpr double kMostSide = 256.0;  // of a picture, in cells
  constexpr double kFinest = 25.0;     // suns that are drawn in all of them
  const double side = kMostSide * std::min(1.0, std::sqrt(kFinest / static_cast<double>(suns)));
  const double width_m = extent.east_m - extent.west_m, height_m = extent.north_m - extent.south_m;
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

Result<std::shared_ptr<const dem::Terrain>> ground_of(const TerrainSite& site, const dem::Extent& extent) {
  constexpr double kMostCells = 512.0;  // along a side
  const dem::GridGeometry& whole = site.info().geometry;
  const dem::Extent map = whole.extent();
  const dem::Extent near{std::max(extent.west_m, map.west_m), std::max(extent.south_m, map.south_m),
                         std::min(extent.east_m, map.east_m), std::min(extent.north_m, map.north_m)};
  const auto window = whole.window(near);
  if (!window) return site.read_samples(map, std::max(whole.rows, whole.columns));
  return site.read_samples(near,
                           static_cast<int>(std::ceil(std::max(window->rows, window->columns) / kMostCells)));
}

ShadowGround::ShadowGround(std::shared_ptr<const dem::Terrain> near, double body_radius_m,
                           const std::shared_ptr<const dem::Terrain>& around)
    : near_(std::move(near)), sweep_(*near_, body_radius_m) {
  if (around) around_.emplace(*around, body_radius_m, near_->geometry().extent());
}

Result<ShadowGround> ShadowGround::read(const TerrainSite& site, const dem::Extent& extent) {
  // Between the last fine cell and the first coarse one no height is known: that lies off the picture.
  const dem::GridGeometry& cells = site.info().geometry;
  const double margin_m = 2.0 * coarser_step(cells) * std::max(cells.cell_x_m, cells.cell_y_m);
  auto near = ground_of(site, {extent.west_m - margin_m, extent.south_m - margin_m, extent.east_m + margin_m,
                               extent.north_m + margin_m});
  if (!near) return fail(near.error());
  const auto around = ground_around(site, **near);
  if (!around) return fail(around.error());
  return ShadowGround(std::move(*near), body_radius_m(site.info().body), *around);
}

dem::RgbaImage ShadowGround::draw(const dem::Extent& extent, const std::vector<sky::Bearing>& suns) const {
  const dem::GridGeometry cells = cells_of(extent, suns.size());
  const dem::Eyes eyes = dem::eyes_over(*near_, cells, 0.0);
  dem::RgbaImage image(cells.rows, cells.columns);
  std::vector<int> lit(image.pixels.size(), 0);
  for (const sky::Bearing& sun : suns) {
    if (sun.elevation_rad <= 0.0) continue;
    std::vector<float> horizon(lit.size(), -std::numeric_limits<float>::infinity());  // its tangent
    const double tangent = std::tan(sun.elevation_rad);
    sweep_.raise(eyes, sun.azimuth_rad, 1, horizon, tangent);
    if (around_) around_->raise(eyes, sun.azimuth_rad, 1, horizon, tangent);
    for (std::size_t k = 0; k < lit.size(); ++k) lit[k] += tangent > horizon[k] ? 1 : 0;
  }
  for (std::size_t k = 0; k < lit.size(); ++k) {
    if (std::isnan(eyes.heights_m[k])) continue;
    if (suns.size() > 1)
      image.pixels[k] = colour_of(lit[k] / static_cast<double>(suns.size()));
    else if (lit[k] == 0)
      image.pixels[k] = kShadow;
  }
  return image;
}

}  // namespace slipway::api
