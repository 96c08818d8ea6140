#pragma once

#include <string>

#include "api/files/terrain_site.h"
#include "api/terrain_views/terrain_layer.h"
#include "core/result.h"
#include "dem/grid_geometry.h"
#include "dem/write/rgba_image.h"

namespace slipway::api {

constexpr int kMaxPicturePx = 2048;  // along each side

// A layer of a terrain over an extent, which may reach beyond the map. Where a pixel is larger than a cell,
// up to nine samples in it are looked at: shading is their mean, slope the steepest, and ground is unknown
// where that of any is. What lies beyond the map is transparent, and so is what has no elevation on the
// hillshade. Errors: not_found (the legend), and those of dem::ElevationSource and
// TerrainSite::read_soils().
struct TerrainPicture {
  TerrainLayer layer = TerrainLayer::kHillshade;
  dem::Extent extent;
  int width_px = 0, height_px = 0;  // in [1, kMaxPicturePx]
  std::string legend;               // of its soils; "": the terrain's first
};
Result<dem::RgbaImage> draw_terrain(const TerrainSite& site, const TerrainPicture& wanted);

// Square tiles of a terrain's own grid: at z = 0 one tile holds all of it, with its north-west corner in the
// terrain's; each step of z halves the side of a tile. x counts tiles to the east, y to the south.
class TerrainTiles {
 public:
  static constexpr int kTilePx = 256;

  explicit TerrainTiles(const dem::GridGeometry& geometry);

  int most_z() const { return most_z_; }  // a cell then has eight pixels or more along a side
  double metres_per_px(int z) const;
  // Whether the tile meets the terrain.
  bool has(int z, long long x, long long y) const;
  dem::Extent extent(int z, long long x, long long y) const;

 private:
  dem::Extent map_;
  double side_m_ = 0.0;  // of the tile of z = 0
  int most_z_ = 0;
};

}  // namespace slipway::api
