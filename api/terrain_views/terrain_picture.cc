#include "api/terrain_views/terrain_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "core/angle.h"
#include "dem/hillshade.h"

namespace slipway::api {
namespace {

constexpr double kSunAzimuth_rad = rad_from_deg(315.0);
constexpr double kSunElevation_rad = rad_from_deg(40.0);
constexpr double kExaggeration = 1.5;
constexpr int kMostSamples = 3;                  // of a pixel along each side
constexpr double kSoilCells = 6'000'000;         // that one picture reads
constexpr long long kSampleBudget = 10'000'000;  // of a picture

// The places that are looked at in a pixel.
class PixelPlaces {
 public:
  PixelPlaces(const TerrainPicture& wanted, const dem::GridGeometry& geometry)
      : extent_(wanted.extent),
        pixel_x_m_((wanted.extent.east_m - wanted.extent.west_m) / wanted.width_px),
        pixel_y_m_((wanted.extent.north_m - wanted.extent.south_m) / wanted.height_px),
        cells_(std::max(pixel_x_m_ / geometry.cell_x_m, pixel_y_m_ / geometry.cell_y_m)) {
    const long long pixels = static_cast<long long>(wanted.width_px) * wanted.height_px;
    const int affordable = static_cast<int>(std::sqrt(static_cast<double>(kSampleBudget / pixels)));
    samples_ = std::clamp(static_cast<int>(std::ceil(std::min<double>(cells_, kMostSamples))), 1,
                          std::max(1, std::min(kMostSamples, affordable)));
  }

  // Every so many cells of the raster one is enough for the samples.
  int step() const {
    constexpr double kMostStep = 1e6;
    return std::max(1, static_cast<int>(std::min(cells_ / samples_, kMostStep)));
  }

  template <class Visit>
  void visit(int row, int column, const Visit& look) const {
    for (int i = 0; i < samples_; ++i) {
      for (int j = 0; j < samples_; ++j) {
        const double right = column + (j + 0.5) / samples_;
        const double down = row + (i + 0.5) / samples_;
        look(extent_.west_m + right * pixel_x_m_, extent_.north_m - down * pixel_y_m_);
      }
    }
  }

 private:
  dem::Extent extent_;
  double pixel_x_m_, pixel_y_m_;
  double cells_;  // along a pixel's side
  int samples_ = 1;
};

dem::Rgba hillshade_at(const dem::Terrain& terrain, const Eigen::Vector3d& sun, const PixelPlaces& places,
                       int row, int column) {
  double light = 0.0;
  int lit = 0;
  places.visit(row, column, [&](double x_m, double y_m) {
    const auto surface = terrain.surface(x_m, y_m);
    if (!surface) return;
    light += dem::light_on(surface->normal, sun, kExaggeration);
    ++lit;
  });
  if (lit == 0) return dem::kTransparent;
  const auto grey = static_cast<std::uint8_t>(std::lround(255.0 * light / lit));
  return {grey, grey, grey, 0xff};
}

dem::Rgba slope_at(const dem::Terrain& terrain, const dem::Extent& map, const PixelPlaces& places, int row,
                   int column) {
  std::optional<double> steepest;
  bool on_map = false;
  places.visit(row, column, [&](double x_m, double y_m) {
    on_map = on_map || map.contains(x_m, y_m);
    if (const auto surface = terrain.surface(x_m, y_m))
      steepest = std::max(steepest.value_or(0.0), surface->slope_rad());
  });
  if (steepest) return slope_colour(deg_from_rad(*steepest));
  return on_map ? hatch(row, column) : dem::kTransparent;
}

dem::Rgba soil_at(const dem::SoilMap& soils, const std::vector<dem::Rgba>& colours, const dem::Extent& map,
                  const PixelPlaces& places, int row, int column) {
  std::optional<std::size_t> soil;
  bool on_map = false, unknown = false;
  places.visit(row, column, [&](double x_m, double y_m) {
    if (!map.contains(x_m, y_m)) return;
    on_map = true;
    const auto here = soils.soil_at(x_m, y_m);
    unknown = unknown || !here;
    soil = here;
  });
  if (!on_map) return dem::kTransparent;
  return unknown || !soil ? hatch(row, column) : colours[*soil];
}

template <class Colour>
dem::RgbaImage painted(const TerrainPicture& wanted, const Colour& colour) {
  dem::RgbaImage image(wanted.height_px, wanted.width_px);
  for (int row = 0; row < image.rows; ++row)
    for (int column = 0; column < image.columns; ++column) image.at(row, column) = colour(row, column);
  return image;
}

double cells_of(const dem::Extent& extent, const dem::GridGeometry& geometry) {
  return (extent.east_m - extent.west_m) / geometry.cell_x_m * (extent.north_m - extent.south_m) /
         geometry.cell_y_m;
}

Result<dem::RgbaImage> draw_soils(const TerrainSite& site, const TerrainPicture& wanted,
                                  const dem::Extent& seen) {
  const Legend* const legend = site.description().legend(wanted.legend);
  if (legend == nullptr)
    return fail(ErrorCode::kNotFound, fmt::format("the terrain has no legend of the name {}", wanted.legend));
  const dem::GridGeometry& geometry = site.info().geometry;
  if (cells_of(seen, geometry) > kSoilCells)
    return fail(ErrorCode::kInvalidRequest,
                fmt::format("the soils of {:.0f} cells are asked for, at most {:.0f} are drawn; choose a "
                            "smaller extent",
                            cells_of(seen, geometry), kSoilCells));
  const auto ground = site.read(seen, *legend);
  if (!ground) return fail(ground.error());
  const dem::SoilMap& soils = *ground->soil_map;
  const std::vector<std::string> order = soils_of(*legend);
  std::vector<dem::Rgba> colours;
  for (const std::string& soil : soils.soils())
    colours.push_back(
        soil_colour(static_cast<std::size_t>(std::find(order.begin(), order.end(), soil) - order.begin())));
  if (wanted.layer == TerrainLayer::kUnknown) colours.assign(colours.size(), dem::kTransparent);
  const PixelPlaces places(wanted, geometry);
  const dem::Extent map = geometry.extent();
  return painted(wanted, [&](int r, int c) { return soil_at(soils, colours, map, places, r, c); });
}

}  // namespace

Result<dem::RgbaImage> draw_terrain(const TerrainSite& site, const TerrainPicture& wanted) {
  const dem::GridGeometry& geometry = site.info().geometry;
  const dem::Extent map = geometry.extent();
  const dem::Extent seen{
      std::max(wanted.extent.west_m, map.west_m), std::max(wanted.extent.south_m, map.south_m),
      std::min(wanted.extent.east_m, map.east_m), std::min(wanted.extent.north_m, map.north_m)};
  if (seen.west_m >= seen.east_m || seen.south_m >= seen.north_m)
    return dem::RgbaImage(wanted.height_px, wanted.width_px);
  if (wanted.layer == TerrainLayer::kSoil || wanted.layer == TerrainLayer::kUnknown)
    return draw_soils(site, wanted, seen);
  const PixelPlaces places(wanted, geometry);
  const auto terrain = site.read_samples(seen, places.step());
  if (!terrain) return fail(terrain.error());
  if (wanted.layer == TerrainLayer::kSlope)
    return painted(wanted, [&](int r, int c) { return slope_at(**terrain, map, places, r, c); });
  const Eigen::Vector3d sun = dem::towards_sun(kSunAzimuth_rad, kSunElevation_rad);
  return painted(wanted, [&](int r, int c) { return hillshade_at(**terrain, sun, places, r, c); });
}

TerrainTiles::TerrainTiles(const dem::GridGeometry& geometry) : map_(geometry.extent()) {
  side_m_ = std::max(map_.east_m - map_.west_m, map_.north_m - map_.south_m);
  const double cell_m = std::min(geometry.cell_x_m, geometry.cell_y_m);
  constexpr double kPixelsOfCell = 8.0;
  while (metres_per_px(most_z_) > cell_m / kPixelsOfCell) ++most_z_;
  const auto cells = [&](int z) {
    const double side = std::ldexp(side_m_, -z);
    return side / geometry.cell_x_m * side / geometry.cell_y_m;
  };
  while (least_z_of_soil_ < most_z_ && cells(least_z_of_soil_) > kSoilCells) ++least_z_of_soil_;
}

double TerrainTiles::metres_per_px(int z) const {
  return std::ldexp(side_m_ / kTilePx, -z);
}

bool TerrainTiles::has(int z, long long x, long long y) const {
  if (z < 0 || z > most_z_ || x < 0 || y < 0 || x >= (1LL << z) || y >= (1LL << z)) return false;
  const dem::Extent tile = extent(z, x, y);
  return tile.west_m < map_.east_m && tile.north_m > map_.south_m;
}

dem::Extent TerrainTiles::extent(int z, long long x, long long y) const {
  const double side = std::ldexp(side_m_, -z);
  const double west = map_.west_m + static_cast<double>(x) * side;
  const double north = map_.north_m - static_cast<double>(y) * side;
  return {west, north - side, west + side, north};
}

}  // namespace slipway::api
