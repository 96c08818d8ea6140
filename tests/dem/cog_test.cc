#include "dem/write/cog.h"

#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "dem/synthetic_terrain.h"
#include "dem/tile_file.h"
#include "dem/write/contours.h"
#include "raster_fixture.h"

namespace slipway::dem {
namespace {

std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

RasterLayer layer_of(int rows, int columns, bool of_classes) {
  RasterLayer layer{.geometry = {rows, columns, 1000.0, 2000.0, 2.0, 3.0}};
  test::prepare_gdal();
  OGRSpatialReference mars;
  mars.SetFromUserInput(test::kMarsSphere);
  char* wkt = nullptr;
  mars.exportToWkt(&wkt);
  layer.crs_wkt = wkt;
  CPLFree(wkt);
  layer.of_classes = of_classes;
  layer.nodata = of_classes ? 0.0 : -9999.0;
  layer.description = "what it shows";
  layer.unit = of_classes ? "" : "1";
  layer.metadata = {{"SLIPWAY_KIND", "test"}};
  if (of_classes) layer.classes = {{1, "GO", {0, 200, 0}}, {4, "NO-GO", {200, 0, 0}}};
  return layer;
}

// Of classes 1 and 4 in a chequerboard of 64 cells, otherwise the row's and column's sum; a corner has none.
float value_at(const RasterLayer& layer, int row, int column) {
  if (row < 100 && column < 100) return static_cast<float>(layer.nodata);
  if (layer.of_classes) return (row / 64 + column / 64) % 2 == 0 ? 1.0F : 4.0F;
  return static_cast<float>(row + column) / 64.0F;
}

void fill(const RasterLayer& layer, TileStore& store) {
  const LevelSize size = size_of_level(layer.geometry, 0);
  for (int tr = 0; tr < size.tile_rows(); ++tr) {
    for (int tc = 0; tc < size.tile_columns(); ++tc) {
      std::vector<std::uint8_t> bytes(layer.cell_bytes() * kTileSide * kTileSide);
      for (int r = 0; r < kTileSide; ++r) {
        for (int c = 0; c < kTileSide; ++c) {
          const int row = tr * kTileSide + r, column = tc * kTileSide + c;
          const bool inside = row < size.rows && column < size.columns;
          const float value = inside ? value_at(layer, row, column) : static_cast<float>(layer.nodata);
          const std::size_t at = static_cast<std::size_t>(r) * kTileSide + static_cast<std::size_t>(c);
          if (layer.of_classes)
            bytes[at] = static_cast<std::uint8_t>(value);
          else
            std::memcpy(bytes.data() + at * sizeof value, &value, sizeof value);
        }
      }
      ASSERT_TRUE(store.write({0, tr, tc}, bytes));
    }
  }
  for (int level = 1; level < levels_of(layer.geometry); ++level) {
    const LevelSize coarse = size_of_level(layer.geometry, level);
    for (int tr = 0; tr < coarse.tile_rows(); ++tr)
      for (int tc = 0; tc < coarse.tile_columns(); ++tc)
        ASSERT_TRUE(write_coarser_tile(layer, {level, tr, tc}, store));
  }
}

TEST(Cog, IsCloudOptimisedAndHoldsWhatWasWritten) {
  const RasterLayer layer = layer_of(1300, 1100, false);
  MemoryTiles tiles;
  fill(layer, tiles);
  const test::TemporaryFolder folder;
  NoProgress progress;
  const auto written = write_cog(folder / "map.tif", layer, tiles, 2, progress);
  ASSERT_TRUE(written) << written.error().detail;
  test::with_gdal(folder / "map.tif", [&](GDALDataset& map) {
    // What GDAL's validator asks for first: the driver itself marks the layout.
    EXPECT_STREQ(map.GetMetadataItem("LAYOUT", "IMAGE_STRUCTURE"), "COG");
    EXPECT_STREQ(map.GetMetadataItem("COMPRESSION", "IMAGE_STRUCTURE"), "DEFLATE");
    EXPECT_STREQ(map.GetMetadataItem("SLIPWAY_KIND"), "test");
    EXPECT_EQ(map.GetRasterXSize(), 1100);
    EXPECT_EQ(map.GetRasterYSize(), 1300);
    double transform[6];
    map.GetGeoTransform(transform);
    EXPECT_EQ(transform[0], 1000.0);
    EXPECT_EQ(transform[3], 2000.0);
    EXPECT_EQ(transform[5], -3.0);
    EXPECT_NEAR(map.GetSpatialRef()->GetSemiMajor(), 3396190.0, 1e-6);
    GDALRasterBand& band = *map.GetRasterBand(1);
    EXPECT_STREQ(band.GetDescription(), "what it shows");
    EXPECT_EQ(band.GetNoDataValue(), -9999.0);
    int width = 0, height = 0;
    band.GetBlockSize(&width, &height);
    EXPECT_EQ(width, kTileSide);
    ASSERT_EQ(band.GetOverviewCount(), 2);
    EXPECT_EQ(band.GetOverview(1)->GetXSize(), 275);
    // The overview lies before the raster in the file, the coarsest first.
    const auto offset = [](GDALRasterBand& of) {
      const char* const text = of.GetMetadataItem("BLOCK_OFFSET_0_0", "TIFF");
      return text != nullptr ? std::stoll(text) : -1;
    };
    EXPECT_LT(offset(*band.GetOverview(1)), offset(*band.GetOverview(0)));
    EXPECT_LT(offset(*band.GetOverview(0)), offset(band));
    float value = 0.0F;
    for (const auto& [row, column] : {std::pair{0, 0}, {700, 300}, {1299, 1099}}) {
      ASSERT_EQ(band.RasterIO(GF_Read, column, row, 1, 1, &value, 1, 1, GDT_Float32, 0, 0, nullptr), CE_None);
      EXPECT_EQ(value, value_at(layer, row, column));
    }
    // The greatest of the four under it.
    ASSERT_EQ(
        band.GetOverview(0)->RasterIO(GF_Read, 300, 400, 1, 1, &value, 1, 1, GDT_Float32, 0, 0, nullptr),
        CE_None);
    EXPECT_EQ(value, value_at(layer, 801, 601));
  });
}

TEST(Cog, OfClassesHasColoursAndTheWorstClassWhenSeenFromFar) {
  const RasterLayer layer = layer_of(600, 1025, true);
  MemoryTiles tiles;
  fill(layer, tiles);
  const test::TemporaryFolder folder;
  NoProgress progress;
  ASSERT_TRUE(write_cog(folder / "classes.tif", layer, tiles, 1, progress));
  test::with_gdal(folder / "classes.tif", [&](GDALDataset& map) {
    GDALRasterBand& band = *map.GetRasterBand(1);
    ASSERT_NE(band.GetColorTable(), nullptr);
    EXPECT_EQ(band.GetColorTable()->GetColorEntry(4)->c1, 200);
    EXPECT_STREQ(band.GetMetadataItem("CLASS_4"), "NO-GO");
    EXPECT_EQ(band.GetNoDataValue(), 0.0);
    std::uint8_t value = 0;
    ASSERT_EQ(band.GetOverview(0)->RasterIO(GF_Read, 96, 96, 1, 1, &value, 1, 1, GDT_Byte, 0, 0, nullptr),
              CE_None);
    EXPECT_EQ(value, static_cast<std::uint8_t>(value_at(layer, 192, 192)));
  });
}

TEST(Cog, HasTheSameBytesForAnyNumberOfThreadsAndWhereverItIsMade) {
  const RasterLayer layer = layer_of(1300, 1100, false);
  MemoryTiles tiles;
  fill(layer, tiles);
  const test::TemporaryFolder folder;
  NoProgress progress;
  ASSERT_TRUE(write_cog(folder / "one.tif", layer, tiles, 1, progress));
  ASSERT_TRUE(write_cog(folder / "four.tif", layer, tiles, 4, progress));
  const auto in_memory = encode_cog(layer, tiles, 2, progress);
  ASSERT_TRUE(in_memory);
  EXPECT_EQ(bytes_of(folder / "one.tif"), bytes_of(folder / "four.tif"));
  EXPECT_EQ(bytes_of(folder / "one.tif"), *in_memory);
}

TEST(Cog, SaysWhyItCanNotBeWrittenAndLeavesNothing) {
  const RasterLayer layer = layer_of(10, 10, false);
  const MemoryTiles none;
  const test::TemporaryFolder folder;
  NoProgress progress;
  const auto written = write_cog(folder / "map.tif", layer, none, 1, progress);
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().code, ErrorCode::kUnwritableFile);
  EXPECT_FALSE(std::filesystem::exists(folder / "map.tif"));
}

TEST(TileFile, HasItsTilesAgainButNotTheOneThatWasCutOff) {
  const test::TemporaryFolder folder;
  const std::vector<std::uint8_t> one(4096, 7), two(4096, 9);
  NoProgress progress;
  {
    auto file = TileFile::open(folder / "map.part", "key", 4096, progress);
    ASSERT_TRUE(file);
    ASSERT_TRUE((*file)->write({0, 0, 0}, one));
    ASSERT_TRUE((*file)->write({0, 0, 1}, two));
  }
  std::filesystem::resize_file(folder / "map.part", std::filesystem::file_size(folder / "map.part") - 100);
  auto again = TileFile::open(folder / "map.part", "key", 4096, progress);
  ASSERT_TRUE(again);
  EXPECT_TRUE((*again)->has({0, 0, 0}));
  EXPECT_FALSE((*again)->has({0, 0, 1}));
  EXPECT_EQ(*(*again)->read({0, 0, 0}), one);
  ASSERT_TRUE((*again)->write({0, 0, 1}, two));
  EXPECT_EQ(*(*again)->read({0, 0, 1}), two);
  // Tiles of another map are not taken.
  auto other = TileFile::open(folder / "map.part", "other", 4096, progress);
  ASSERT_TRUE(other);
  EXPECT_FALSE((*other)->has({0, 0, 0}));
}

TEST(Contours, AreLinesOfTheirHeight) {
  const auto bowl = make_crater({.size_m = 40.0, .cell_m = 0.5}, 15.0, 3.0);
  NoProgress progress;
  const auto lines = contours_of(*bowl, 1.0, 0.5, progress);
  ASSERT_TRUE(lines) << lines.error().detail;
  ASSERT_FALSE(lines->features.empty());
  for (const VectorFeature& line : lines->features) {
    const double height = std::get<double>(line.values.at(0));
    EXPECT_NEAR(std::remainder(height - 0.5, 1.0), 0.0, 1e-9);
    for (const auto& [x, y, z] : line.points) EXPECT_NEAR(bowl->height_m(x, y).value_or(-99.0), height, 0.05);
  }
}

}  // namespace
}  // namespace slipway::dem
