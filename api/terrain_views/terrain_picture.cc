#include "api/terrain_views/terrain_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "core/angle.h"
#include "dem/gradient_field.h"
#include "dem/write/hillshade.h"

namespace slipway::api {
namespace {

constexpr double kSunAzimuth_rad = rad_from_deg(315.0);
constexpr double kSunElevation_rad = rad_from_deg(40.0);
constexpr double kExaggeration = 1.5;
constexpr int kMostSamples = 3;                  // of a pixel along each side
constexpr int kMostSamplesOfLight = 2;           // which is a mean: those of the worst need more
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
    const int most = wanted.layer == TerrainLayer::kHillshade ? kMostSamplesOfLight : kMostSamples;
    samples_ = std::clamp(static_cast<int>(std::ceil(std::min<double>(cells_, most))), 1,
                          std::max(1, std::min(most, affordable)));
  }

  // Every so many cells of the raster one is enough for the samples.
  int step() const {
    constexpr double kMostStep = 1e6;
    return std::max(1, static_cast<int>(std::min(cells_ / samples_, kMostStep)));
  }

  int samples() const { return samples_; }  // of a pixel along a side
  // Of the k-th sample of a column of the picture, and of one of its rows.
  double x_m(int column, int k) const {
    return extent_.west_m + (column + (k + 0.5) / samples_) * pixel_x_m_;
  }
  double y_m(int row, int k) const { return extent_.north_m - (row + (k + 0.5) / samples_) * pixel_y_m_; }

  template <class Visit>
  void visit(int row, int column, const Visit& look) const {
    for (int i = 0; i < samples_; ++i)
      for (int j = 0; j < samples_; ++j) look(x_m(column, j), y_m(row, i));
  }

 private:
  dem::Extent extent_;
  double pixel_x_m_, pixel_y_m_;
  double cells_;  // along a pixel's side
  int samples_ = 1;
};

// What the samples of a pixel saw of the relief: what its layer needs of it.
struct SeenRelief {
  double light = 0.0;     // of those that lie on ground, the sum
  double steepest = 0.0;  // tangent of the slope, of these
  int on_ground = 0;
};

dem::Rgba shade_of(const SeenRelief& seen) {
  if (seen.on_ground == 0) return dem::kTransparent;
  const auto grey = static_cast<std::uint8_t>(std::lround(255.0 * seen.light / seen.on_ground));
  return {grey, grey, grey, 0xff};
}

const Eigen::Vector3d& sun() {
  static const Eigen::Vector3d direction = dem::towards_sun(kSunAzimuth_rad, kSunElevation_rad);
  return direction;
}

// At every sample the terrain itself is asked: where some of its cells have no data.
class SurfaceLooks {
 public:
  SurfaceLooks(const dem::Terrain& terrain, const PixelPlaces& places) : terrain_(terrain), places_(places) {}

  SeenRelief at(int row, int column) const {
    SeenRelief seen;
    places_.visit(row, column, [&](double x_m, double y_m) {
      const auto surface = terrain_.surface(x_m, y_m);
      if (!surface) return;
      seen.light += dem::light_on(surface->normal, sun(), kExaggeration);
      seen.steepest = std::max(seen.steepest, std::tan(surface->slope_rad()));
      ++seen.on_ground;
    });
    return seen;
  }

 private:
  const dem::Terrain& terrain_;
  const PixelPlaces& places_;
};

// The same where every cell has data, by far quicker: a tile has 600,000 samples.
class GradientLooks {
 public:
  GradientLooks(const dem::GradientField& field, const PixelPlaces& places, const TerrainPicture& wanted)
      : field_(field), samples_(places.samples()), lit_(wanted.layer == TerrainLayer::kHillshade) {
    for (int row = 0; row < wanted.height_px; ++row)
      for (int k = 0; k < samples_; ++k) rows_.push_back(field.row_at(places.y_m(row, k)));
    for (int column = 0; column < wanted.width_px; ++column)
      for (int k = 0; k < samples_; ++k) columns_.push_back(field.column_at(places.x_m(column, k)));
  }

  SeenRelief at(int row, int column) const {
    SeenRelief seen;
    float steepest = 0.0F;
    for (int i = 0; i < samples_; ++i) {
      const dem::BetweenCentres& down = rows_[static_cast<std::size_t>(row * samples_ + i)];
      for (int j = 0; j < samples_; ++j) {
        const dem::BetweenCentres& right = columns_[static_cast<std::size_t>(column * samples_ + j)];
        if (!down.inside || !right.inside) continue;
        const Eigen::Vector2f gradient = field_.at(down, right);
        if (lit_)
          seen.light += dem::light_on_gradient(gradient, sun(), kExaggeration);
        else
          steepest = std::max(steepest, gradient.squaredNorm());
        ++seen.on_ground;
      }
    }
    seen.steepest = std::sqrt(steepest);
    return seen;
  }

 private:
  const dem::GradientField& field_;
  int samples_;
  bool lit_;  // the light is asked for, else the steepest
  std::vector<dem::BetweenCentres> rows_, columns_;
};

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

template <class Looks>
dem::RgbaImage draw_relief(const Looks& looks, const TerrainPicture& wanted, const dem::Extent& map,
                           const PixelPlaces& places) {
  if (wanted.layer == TerrainLayer::kHillshade)
    return painted(wanted, [&](int row, int column) { return shade_of(looks.at(row, column)); });
  return painted(wanted, [&](int row, int column) {
    const SeenRelief seen = looks.at(row, column);
    if (seen.on_ground > 0) return slope_colour(deg_from_rad(std::atan(seen.steepest)));
    bool on_map = false;
    places.visit(row, column, [&](double x_m, double y_m) { on_map = on_map || map.contains(x_m, y_m); });
    return on_map ? hatch(row, column) : dem::kTransparent;
  });
}

Result<dem::RgbaImage> draw_soils(const TerrainSite& site, const TerrainPicture& wanted,
                                  const dem::Extent& seen) {
  const Legend* const legend = site.description().legend(wanted.legend);
  if (legend == nullptr)
    return fail(ErrorCode::kNotFound, fmt::format("the terrain has no legend of the name {}", wanted.legend));
  const dem::GridGeometry& geometry = site.info().geometry;
  const PixelPlaces places(wanted, geometry);
  const auto read = site.soils_for_pictures(seen, *legend, places.step());
  if (!read) return fail(read.error());
  const dem::SoilMap& soils = **read;
  const std::vector<std::string> order = soils_of(*legend);
  std::vector<dem::Rgba> colours;
  for (const std::string& soil : soils.soils())
    colours.push_back(
        soil_colour(static_cast<std::size_t>(std::find(order.begin(), order.end(), soil) - order.begin())));
  if (wanted.layer == TerrainLayer::kUnknown) colours.assign(colours.size(), dem::kTransparent);
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
  const auto field = dem::GradientField::of(**terrain);
  return field ? draw_relief(GradientLooks(*field, places, wanted), wanted, map, places)
               : draw_relief(SurfaceLooks(**terrain, places), wanted, map, places);
}

TerrainTiles::TerrainTiles(const dem::GridGeometry& geometry) : map_(geometry.extent()) {
  side_m_ = std::max(map_.east_m - map_.west_m, map_.north_m - map_.south_m);
  const double cell_m = std::min(geometry.cell_x_m, geometry.cell_y_m);
  constexpr double kPixelsOfCell = 8.0;
  while (metres_per_px(most_z_) > cell_m / kPixelsOfCell) ++most_z_;
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
