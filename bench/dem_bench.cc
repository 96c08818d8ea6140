// The cost of reading the ground's height, of opening a large elevation raster, and of reading a window of
// it.

#include <benchmark/benchmark.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "core/random.h"
#include "dem/elevation_source.h"
#include "dem/horizon/horizon.h"
#include "dem/horizon/horizon_sweep.h"
#include "dem/synthetic_terrain.h"

namespace slipway::dem {
namespace {

constexpr int kSide = 16384;
constexpr int kTile = 256;
constexpr int kTilesAcross = kSide / kTile;

// A little-endian GeoTIFF, tiled and sparse, UTM zone 30 N: header and tags, then the tiles that hold the
// window. The vendor's library stays behind its fence, so the bench writes the few tags itself.
class SparseGeoTiff {
 public:
  explicit SparseGeoTiff(std::filesystem::path path) : path_(std::move(path)) {
    std::vector<std::uint32_t> offsets(static_cast<std::size_t>(kTilesAcross) * kTilesAcross, 0);
    std::vector<std::uint32_t> sizes(offsets.size(), 0);
    constexpr std::uint32_t kTileBytes = kTile * kTile * 4;
    const auto tables = static_cast<std::uint32_t>(8 * offsets.size());
    constexpr std::uint32_t kData = 1024;  // header, tags and their short values fit before this
    std::uint32_t next = kData + tables;
    for (int row = 30; row < 34; ++row) {
      for (int column = 30; column < 34; ++column) {
        const auto tile = static_cast<std::size_t>(row) * kTilesAcross + static_cast<std::size_t>(column);
        offsets[tile] = next;
        sizes[tile] = kTileBytes;
        next += kTileBytes;
      }
    }
    write_tags(kData, static_cast<std::uint32_t>(kData + 4 * offsets.size()),
               static_cast<std::uint32_t>(offsets.size()));
    bytes_.resize(kData);
    for (const std::uint32_t offset : offsets) put(offset, 4);
    for (const std::uint32_t size : sizes) put(size, 4);
    for (std::uint32_t i = 0; i < 16U * kTile * kTile; ++i) {
      put(std::bit_cast<std::uint32_t>(static_cast<float>(i % 100)), 4);
    }
    std::ofstream(path_, std::ios::binary).write(bytes_.data(), static_cast<std::streamsize>(bytes_.size()));
  }
  ~SparseGeoTiff() { std::filesystem::remove(path_); }
  SparseGeoTiff(const SparseGeoTiff&) = delete;
  SparseGeoTiff& operator=(const SparseGeoTiff&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  enum Type : std::uint32_t { kShort = 3, kLong = 4, kDouble = 12 };

  void put(std::uint64_t value, int size) {
    for (int i = 0; i < size; ++i) bytes_.push_back(static_cast<char>((value >> (8 * i)) & 0xff));
  }
  void tag(std::uint32_t number, Type type, std::uint32_t count, std::uint32_t value) {
    put(number, 2);
    put(type, 2);
    put(count, 4);
    put(value, 4);
  }
  void write_tags(std::uint32_t offsets, std::uint32_t sizes, std::uint32_t tiles) {
    constexpr std::uint32_t kScale = 512;
    constexpr std::uint32_t kTiePoint = 544;
    constexpr std::uint32_t kKeys = 600;
    bytes_ = "II*";
    bytes_.push_back('\0');
    put(8, 4);
    put(14, 2);
    tag(256, kLong, 1, kSide);          // width
    tag(257, kLong, 1, kSide);          // height
    tag(258, kShort, 1, 32);            // bits a sample
    tag(259, kShort, 1, 1);             // not compressed
    tag(262, kShort, 1, 1);             // black is zero
    tag(277, kShort, 1, 1);             // samples a pixel
    tag(322, kShort, 1, kTile);         // tile width
    tag(323, kShort, 1, kTile);         // tile height
    tag(324, kLong, tiles, offsets);    // where the tiles are
    tag(325, kLong, tiles, sizes);      // how long they are
    tag(339, kShort, 1, 3);             // floating point
    tag(33550, kDouble, 3, kScale);     // size of a pixel
    tag(33922, kDouble, 6, kTiePoint);  // a pixel and its place
    tag(34735, kShort, 16, kKeys);      // the coordinate system
    put(0, 4);                          // no further directory
    bytes_.resize(kScale);
    for (const double v : {1.0, 1.0, 0.0}) put(std::bit_cast<std::uint64_t>(v), 8);
    bytes_.resize(kTiePoint);
    for (const double v : {0.0, 0.0, 0.0, 300000.0, 4000000.0, 0.0}) put(std::bit_cast<std::uint64_t>(v), 8);
    bytes_.resize(kKeys);
    // Projected, pixels are areas, EPSG:32630.
    for (const std::uint32_t key :
         {1U, 1U, 0U, 3U, 1024U, 0U, 1U, 1U, 1025U, 0U, 1U, 1U, 3072U, 0U, 1U, 32630U}) {
      put(key, 2);
    }
  }

  std::filesystem::path path_;
  std::string bytes_;
};

// 4,096 places spread over the grid, so that neither the branch predictor nor the cache sees a path.
std::vector<Eigen::Vector2d> places(double half_m) {
  std::vector<Eigen::Vector2d> answer;
  for (std::uint64_t i = 0; i < 4096; ++i) {
    answer.emplace_back(half_m * (2.0 * random_uniform(1, i) - 1.0),
                        half_m * (2.0 * random_uniform(2, i) - 1.0));
  }
  return answer;
}

void height_lookup(benchmark::State& state) {
  const auto terrain = make_crater({.size_m = 600.0, .cell_m = 1.0}, 200.0, 40.0);
  const auto where = places(299.0);
  std::size_t i = 0;
  for ([[maybe_unused]] auto _ : state) {
    const Eigen::Vector2d& p = where[i++ % where.size()];
    benchmark::DoNotOptimize(terrain->height_m(p.x(), p.y()));
  }
}
BENCHMARK(height_lookup);

void surface_lookup(benchmark::State& state) {
  const auto terrain = make_crater({.size_m = 600.0, .cell_m = 1.0}, 200.0, 40.0);
  const auto where = places(299.0);
  std::size_t i = 0;
  for ([[maybe_unused]] auto _ : state) {
    const Eigen::Vector2d& p = where[i++ % where.size()];
    benchmark::DoNotOptimize(terrain->surface(p.x(), p.y()));
  }
}
BENCHMARK(surface_lookup);

void open_and_read_300_x_300_of_16384_x_16384(benchmark::State& state) {
  const SparseGeoTiff raster(std::filesystem::temp_directory_path() /
                             ("slipway_dem_bench_" + std::to_string(getpid()) + ".tif"));
  const Extent extent{.west_m = 308000.0, .south_m = 3991700.0, .east_m = 308300.0, .north_m = 3992000.0};
  for ([[maybe_unused]] auto _ : state) {
    const auto source = open_elevation(raster.path());
    if (!source) {
      state.SkipWithError(source.error().detail.c_str());
      break;
    }
    const auto terrain = (*source)->read(extent);
    if (!terrain || !(*terrain)->height_m(308150.0, 3991850.0)) {
      state.SkipWithError("the window could not be read");
      break;
    }
    benchmark::DoNotOptimize(terrain);
  }
}
BENCHMARK(open_and_read_300_x_300_of_16384_x_16384)->Unit(benchmark::kMillisecond);

}  // namespace
// The horizon in one direction from every cell of rough ground: by a ray of its own, and by lines over all of
// it at once.
std::shared_ptr<const Terrain> rough_ground() {
  const GridGeometry g{512, 512, 0.0, 512.0, 1.0, 1.0};
  std::vector<float> heights;
  for (int row = 0; row < g.rows; ++row)
    for (int column = 0; column < g.columns; ++column)
      heights.push_back(static_cast<float>(8.0 * std::sin(column / 61.0) * std::cos(row / 47.0) +
                                           std::sin(row / 5.0) * std::cos(column / 7.0) +
                                           0.1 * std::sin(1.3 * row * column)));
  std::vector<std::uint8_t> all(heights.size(), 1);
  return std::make_shared<const Terrain>(g, std::move(heights), std::move(all));
}

void horizon_by_rays(benchmark::State& state) {
  const auto ground = rough_ground();
  const Horizon horizon(ground, 3'389'500.0);
  const GridGeometry& cells = ground->geometry();
  for ([[maybe_unused]] auto _ : state)
    for (int row = 0; row < cells.rows; row += 8)
      for (int column = 0; column < cells.columns; column += 8) {
        const Eigen::Vector2d at = cells.centre_m({row, column});
        benchmark::DoNotOptimize(horizon.elevation_rad(at.x(), at.y(), 1.0, 1.0));
      }
  state.SetItemsProcessed(state.iterations() * cells.rows * cells.columns / 64);
}
BENCHMARK(horizon_by_rays);

void horizon_by_sweep(benchmark::State& state) {
  const auto ground = rough_ground();
  const HorizonSweep sweep(*ground, 3'389'500.0);
  const Eyes eyes = eyes_over(*ground, ground->geometry(), 1.0);
  std::vector<float> tangents(eyes.heights_m.size());
  for ([[maybe_unused]] auto _ : state) {
    std::fill(tangents.begin(), tangents.end(), -std::numeric_limits<float>::infinity());
    sweep.raise(eyes, 1.0, 1, tangents);
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(tangents.size()));
}
BENCHMARK(horizon_by_sweep);

}  // namespace slipway::dem
