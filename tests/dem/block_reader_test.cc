#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <filesystem>
#include <limits>
#include <thread>
#include <vector>

#include "dem/gdal_block_reader.h"
#include "dem/gdal_raster.h"
#include "raster_fixture.h"

namespace slipway::dem {
namespace {

using test::RasterOptions;
using test::TemporaryFolder;
using test::write_geotiff;

constexpr float kNothing = -9999.0F;

// Three by four blocks of 64 cells, the last ones not whole, with a hole across four of them.
RasterOptions tiled_raster(float base_m) {
  RasterOptions options{.rows = 150, .columns = 230};
  options.creation = {"TILED=YES", "BLOCKXSIZE=64", "BLOCKYSIZE=64", "COMPRESS=DEFLATE", "PREDICTOR=3"};
  options.also = [](GDALDataset& raster) { raster.GetRasterBand(1)->SetNoDataValue(kNothing); };
  options.overviews = {2, 4};
  for (int row = 0; row < options.rows; ++row)
    for (int column = 0; column < options.columns; ++column) {
      const bool is_hole = std::abs(row - 64) < 5 && std::abs(column - 128) < 7;
      options.cells.push_back(is_hole ? kNothing
                                      : base_m + static_cast<float>(0.5 * row * row - 3.0 * column));
    }
  return options;
}

// With GDAL's opening of the file beside it.
struct Opened {
  GDALDatasetUniquePtr dataset;
  HeightEncoding encoding;
  std::unique_ptr<GdalBlockReader> reader;
};

Opened open_blocks(const std::filesystem::path& path, std::size_t max_bytes = GdalBlockReader::kMaxBytes) {
  const GdalSession session(path);
  Opened opened{.dataset = open_raster(path, session).value(), .encoding = {}, .reader = nullptr};
  opened.encoding = encoding_of(*opened.dataset->GetRasterBand(1));
  opened.reader = GdalBlockReader::of(path, *opened.dataset, opened.encoding, max_bytes);
  return opened;
}

struct Cells {
  std::vector<float> heights_m;
  std::vector<std::uint8_t> valid;
  bool operator==(const Cells&) const = default;
};

Cells of_reader(GdalBlockReader& reader, int overview, const CellWindow& window) {
  const auto count = static_cast<std::size_t>(window.rows) * static_cast<std::size_t>(window.columns);
  Cells cells{std::vector<float>(count), std::vector<std::uint8_t>(count)};
  if (!reader.read(overview, window, cells.heights_m.data(), cells.valid.data())) return {};
  return cells;
}

Cells of_gdal(const Opened& opened, int overview, const CellWindow& window) {
  const auto count = static_cast<std::size_t>(window.rows) * static_cast<std::size_t>(window.columns);
  Cells cells{std::vector<float>(count), std::vector<std::uint8_t>(count)};
  GDALRasterBand& band = *opened.dataset->GetRasterBand(1);
  const bool read = read_heights(overview < 0 ? band : *band.GetOverview(overview), opened.encoding, window,
                                 cells.heights_m.data(), cells.valid.data());
  return read ? cells : Cells{};
}

TEST(BlockReader, ManyThreadsGetTheCellsThatGdalGetsWhetherBlocksAreKeptOrNot) {
  const TemporaryFolder folder;
  write_geotiff(folder / "grid.tif", tiled_raster(100.0F));
  constexpr std::size_t kTwoBlocks = 2 * 64 * 64 * sizeof(float);
  for (const std::size_t max_bytes : {GdalBlockReader::kMaxBytes, kTwoBlocks, std::size_t{1}}) {
    const Opened opened = open_blocks(folder / "grid.tif", max_bytes);
    ASSERT_NE(opened.reader, nullptr);
    const std::vector<std::pair<int, CellWindow>> windows{{GdalBlockReader::kItself, {0, 0, 150, 230}},
                                                          {GdalBlockReader::kItself, {60, 100, 20, 70}},
                                                          {GdalBlockReader::kItself, {149, 229, 1, 1}},
                                                          {0, {0, 0, 75, 115}},
                                                          {0, {25, 55, 15, 20}},
                                                          {1, {0, 0, 38, 58}}};
    std::vector<Cells> truth;
    for (const auto& [overview, window] : windows) truth.push_back(of_gdal(opened, overview, window));
    ASSERT_EQ(std::count(truth[0].valid.begin(), truth[0].valid.end(), 0), 9 * 13) << "the hole";
    std::atomic<int> wrong = 0;
    std::vector<std::thread> threads;
    for (std::size_t thread = 0; thread < 4; ++thread)
      threads.emplace_back([&, thread] {
        for (std::size_t k = 0; k < 60; ++k) {
          const std::size_t at = (k + thread) % windows.size();
          if (of_reader(*opened.reader, windows[at].first, windows[at].second) != truth[at]) ++wrong;
        }
      });
    for (std::thread& thread : threads) thread.join();
    EXPECT_EQ(wrong, 0) << max_bytes;
  }
}

// Two of its openings would else show two maps.
TEST(BlockReader, AnotherFileOfTheSameNameIsNotRead) {
  const TemporaryFolder folder;
  write_geotiff(folder / "grid.tif", tiled_raster(100.0F));
  write_geotiff(folder / "other.tif", tiled_raster(500.0F));
  const Opened opened = open_blocks(folder / "grid.tif");
  std::filesystem::rename(folder / "other.tif", folder / "grid.tif");
  EXPECT_EQ(of_reader(*opened.reader, GdalBlockReader::kItself, {0, 0, 10, 10}), Cells{});
}

TEST(BlockReader, CellsThatAreStoredInAnotherWayAreLeftToTheDataset) {
  const TemporaryFolder folder;
  const auto reads = [&](const RasterOptions& options) {
    write_geotiff(folder / "grid.tif", options);
    return open_blocks(folder / "grid.tif").reader != nullptr;
  };
  EXPECT_TRUE(reads(tiled_raster(0.0F)));
  RasterOptions strips = tiled_raster(0.0F);
  strips.creation.clear();
  EXPECT_FALSE(reads(strips));
  RasterOptions scaled = tiled_raster(0.0F);
  scaled.also = [](GDALDataset& raster) { raster.GetRasterBand(1)->SetScale(2.0); };
  EXPECT_FALSE(reads(scaled));
  RasterOptions whole_numbers = tiled_raster(0.0F);
  whole_numbers.type = GDT_Int32;
  whole_numbers.creation.pop_back();
  EXPECT_FALSE(reads(whole_numbers));
}

// The pictures of the service come from several threads.
TEST(BlockReader, SamplesOfATerrainAreThoseOfItsWindow) {
  const TemporaryFolder folder;
  write_geotiff(folder / "grid.tif", tiled_raster(100.0F));
  const auto source = open_elevation(folder / "grid.tif").value();
  const Extent extent = source->info().geometry.extent();
  const auto window = source->read(extent).value();
  const auto samples = source->read_samples(extent, 1).value();
  EXPECT_EQ(samples->fingerprint(), window->fingerprint());
}

}  // namespace
}  // namespace slipway::dem
