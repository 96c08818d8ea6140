#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "core/result.h"
#include "dem/grid_geometry.h"

namespace slipway::dem {

// One class of a raster of classes.
struct RasterClass {
  std::uint8_t value = 0;
  std::string name;
  std::array<std::uint8_t, 3> colour{};  // red, green, blue
};

// What a coarser level shows of the four cells under one of its own. Where two or more of them have no value
// it has none either.
enum class Coarser {
  kGreatest,   // of these: where a greater value is a worse one, no level looks better than the ground
  kCommonest,  // of these, the least of equally common ones
};

// A raster of one band as it is to be written, without its cells.
struct RasterLayer {
  GridGeometry geometry;
  std::string crs_wkt = {};  // empty: a local frame
  bool of_classes = false;   // bytes with a colour table; otherwise Float32
  double nodata = 0.0;
  Coarser coarser = Coarser::kGreatest;
  std::string description = {}, unit = {};  // of the band
  std::vector<RasterClass> classes = {};
  std::vector<std::pair<std::string, std::string>> metadata = {};       // of the file
  std::vector<std::pair<std::string, std::string>> band_metadata = {};  // "STATISTICS_MINIMUM", ...

  std::size_t cell_bytes() const { return of_classes ? sizeof(std::uint8_t) : sizeof(float); }
};

constexpr int kTileSide = 512;  // cells; a raster is computed, kept and written in squares of this side

// A square of cells of one level; level 0 is the raster, each next one has half as many rows and columns,
// rounded up.
struct TileIndex {
  int level = 0, row = 0, column = 0;
  auto operator<=>(const TileIndex&) const = default;
};

struct LevelSize {
  int rows = 0, columns = 0;
  int tile_rows() const { return (rows + kTileSide - 1) / kTileSide; }
  int tile_columns() const { return (columns + kTileSide - 1) / kTileSide; }
};
LevelSize size_of_level(const GridGeometry& geometry, int level);
// As many as it takes for the last one to fit into one tile.
int levels_of(const GridGeometry& geometry);

// The tiles of a raster. Each has kTileSide * kTileSide cells row by row, those beyond the raster's edge
// without a value. Writing is thread-safe.
class TileStore {
 public:
  virtual ~TileStore() = default;
  virtual bool has(const TileIndex& tile) const = 0;
  virtual Result<void> write(const TileIndex& tile, const std::vector<std::uint8_t>& bytes) = 0;
  virtual Result<std::vector<std::uint8_t>> read(const TileIndex& tile) const = 0;
};

class MemoryTiles final : public TileStore {
 public:
  bool has(const TileIndex& tile) const override;
  Result<void> write(const TileIndex& tile, const std::vector<std::uint8_t>& bytes) override;
  Result<std::vector<std::uint8_t>> read(const TileIndex& tile) const override;

 private:
  mutable std::mutex mutex_;
  std::map<TileIndex, std::vector<std::uint8_t>> tiles_;
};

// One level's tile from the four tiles of the finer level under it, which the store has.
Result<void> write_coarser_tile(const RasterLayer& layer, const TileIndex& tile, TileStore& store);

}  // namespace slipway::dem
