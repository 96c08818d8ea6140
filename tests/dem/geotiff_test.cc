#include "dem/geotiff.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "dem/elevation_source.h"
#include "raster_fixture.h"

namespace slipway::dem {
namespace {

TEST(Geotiff, IsReadBackAsItWas) {
  const auto gale =
      open_elevation(std::filesystem::path(SLIPWAY_SOURCE_DIR) / "data/terrains/gale/elevation.tif");
  ASSERT_TRUE(gale) << gale.error().detail;
  const Extent whole = (*gale)->info().geometry.extent();
  const double x_m = 0.5 * (whole.west_m + whole.east_m), y_m = 0.5 * (whole.south_m + whole.north_m);
  const auto window = (*gale)->read({x_m - 20.0, y_m - 20.0, x_m + 20.0, y_m + 20.0});
  ASSERT_TRUE(window);
  const auto bytes = encode_geotiff(**window, (*gale)->info().crs_wkt);
  ASSERT_TRUE(bytes) << bytes.error().detail;
  const test::TemporaryFolder folder;
  const std::filesystem::path path = folder.write("window.tif", *bytes);
  const auto again = open_elevation(path);
  ASSERT_TRUE(again) << again.error().detail;
  const auto read = (*again)->read((*again)->info().geometry.extent());
  ASSERT_TRUE(read);
  EXPECT_EQ((*read)->fingerprint(), (*window)->fingerprint());
  EXPECT_EQ(*encode_geotiff(**window, (*gale)->info().crs_wkt), *bytes);
}

TEST(Geotiff, KeepsMissingCellsMissing) {
  const Terrain terrain({.rows = 2, .columns = 2, .cell_x_m = 0.5, .cell_y_m = 0.5}, {1.0F, 0.0F, 3.0F, 4.0F},
                        {1, 0, 1, 1});
  const auto gale =
      open_elevation(std::filesystem::path(SLIPWAY_SOURCE_DIR) / "data/terrains/gale/elevation.tif");
  const auto placed = encode_geotiff(terrain, (*gale)->info().crs_wkt);
  ASSERT_TRUE(placed);
  const test::TemporaryFolder places;
  const auto source = open_elevation(places.write("placed.tif", *placed));
  ASSERT_TRUE(source) << source.error().detail;
  const auto read = (*source)->read((*source)->info().geometry.extent());
  EXPECT_EQ((*read)->fingerprint(), terrain.fingerprint());
}

TEST(Geotiff, WithoutASystemItHasNoPlaceOnAPlanet) {
  const Terrain terrain({.rows = 2, .columns = 2}, {1.0F, 2.0F, 3.0F, 4.0F}, {1, 1, 1, 1});
  const auto bytes = encode_geotiff(terrain, "");
  ASSERT_TRUE(bytes);
  // Fit for a campaign's folder, not for planning.
  const test::TemporaryFolder folder;
  const std::filesystem::path path = folder.write("bare.tif", *bytes);
  EXPECT_FALSE(open_elevation(path));
}

}  // namespace
}  // namespace slipway::dem
