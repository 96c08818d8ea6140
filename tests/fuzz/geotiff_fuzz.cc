// The readers of rasters: heights and soil classes.

#include <algorithm>

#include "dem/elevation_source.h"
#include "dem/soil_map.h"
#include "fuzz_target.h"

namespace {

// 64 x 64 cells: what is read, not how much, is what matters here.
slipway::dem::Extent north_west_of(const slipway::dem::GridGeometry& grid) {
  slipway::dem::Extent corner = grid.extent();
  corner.east_m = std::min(corner.east_m, corner.west_m + 64.0 * grid.cell_x_m);
  corner.south_m = std::max(corner.south_m, corner.north_m - 64.0 * grid.cell_y_m);
  return corner;
}

slipway::dem::Extent south_east_of(const slipway::dem::GridGeometry& grid) {
  slipway::dem::Extent corner = grid.extent();
  corner.west_m = std::max(corner.west_m, corner.east_m - 64.0 * grid.cell_x_m);
  corner.north_m = std::min(corner.north_m, corner.south_m + 64.0 * grid.cell_y_m);
  return corner;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace slipway;
  const auto path = fuzz::as_file(fuzz::text_of(data, size), "raster.tif");
  const auto source = dem::open_elevation(path, dem::PlacelessRaster::kLocalFrame);
  dem::ElevationInfo ground;
  if (source) {
    ground = (*source)->info();
    for (const dem::Extent& corner : {north_west_of(ground.geometry), south_east_of(ground.geometry)}) {
      const auto terrain = (*source)->read(corner);
      fuzz::require(terrain || !terrain.error().detail.empty(), "a refusal says why");
    }
  } else {
    fuzz::require(!source.error().detail.empty(), "a refusal says why");
    ground.geometry = {
        .rows = 8, .columns = 8, .west_m = 0.0, .north_m = 8.0, .cell_x_m = 1.0, .cell_y_m = 1.0};
  }
  const auto soil = dem::read_soil_raster(path, ground, south_east_of(ground.geometry),
                                          {{1, "sand", "sand"}, {2, "rock", {}}});
  fuzz::require(soil || !soil.error().detail.empty(), "a refusal says why");
  return 0;
}
