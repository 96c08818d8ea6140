#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "core/result.h"
#include "dem/grid_geometry.h"
#include "dem/terrain.h"

namespace slipway::dem {

// Memory that reads as zeros and costs only the pages that are written.
template <class T>
class SparsePages {
 public:
  explicit SparsePages(std::size_t count);
  ~SparsePages();
  SparsePages(const SparsePages&) = delete;
  SparsePages& operator=(const SparsePages&) = delete;
  T* data() const { return data_; }

 private:
  std::size_t bytes_;
  T* data_;
};

// The cells of a terrain that is read by tiles, row by row as of one that is held whole. Thread-safe: a tile
// is read once, by the first who asks.
class TerrainTiles {
 public:
  TerrainTiles(const GridGeometry& geometry, std::shared_ptr<const CellReader> cells);

  const float* heights_m() const { return heights_m_.data(); }
  const std::uint8_t* valid() const { return valid_.data(); }
  // The cells of a window, which are not kept here. False where they can't be read, which damage() says too.
  bool read_part(const CellWindow& window, float* heights_m, std::uint8_t* valid) const;

  // Reads the tiles of these cells, clipped to the terrain. True where every cell of these tiles has data.
  bool need(int first_row, int first_column, int last_row, int last_column) const;
  std::optional<Error> damage() const;
  // Which tiles were read, in their order, as windows.
  std::vector<CellWindow> read_tiles() const;

 private:
  enum State : std::uint8_t { kUnread, kWithGaps, kWhole };

  State read(std::size_t tile) const;
  CellWindow window_of(std::size_t tile) const;

  GridGeometry geometry_;
  std::shared_ptr<const CellReader> cells_;
  SparsePages<float> heights_m_;
  SparsePages<std::uint8_t> valid_;
  std::size_t tile_columns_, tile_rows_;
  mutable std::vector<std::atomic<std::uint8_t>> states_;
  mutable std::mutex reading_;
  mutable std::optional<Error> damage_;
};

}  // namespace slipway::dem
