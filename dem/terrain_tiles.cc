#include "dem/terrain_tiles.h"

#include <sys/mman.h>

#include <algorithm>
#include <new>
#include <utility>

namespace slipway::dem {
namespace {

// Long rows: pages hold pieces of rows.
constexpr int kTileRows = 128, kTileColumns = 512;

std::size_t tiles_across(int cells, int per_tile) {
  return static_cast<std::size_t>((cells - 1) / per_tile + 1);
}

}  // namespace

template <class T>
SparsePages<T>::SparsePages(std::size_t count) : bytes_(count * sizeof(T)) {
  void* const pages =
      mmap(nullptr, bytes_, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (pages == MAP_FAILED) throw std::bad_alloc();
  // Pages of 2 MB would make a thin corridor cost as much as the whole window.
  static_cast<void>(madvise(pages, bytes_, MADV_NOHUGEPAGE));
  data_ = static_cast<T*>(pages);
}

template <class T>
SparsePages<T>::~SparsePages() {
  munmap(data_, bytes_);
}

template class SparsePages<float>;
template class SparsePages<std::uint8_t>;

TerrainTiles::TerrainTiles(const GridGeometry& geometry, std::shared_ptr<const CellReader> cells)
    : geometry_(geometry),
      cells_(std::move(cells)),
      heights_m_(static_cast<std::size_t>(geometry.rows) * static_cast<std::size_t>(geometry.columns)),
      valid_(static_cast<std::size_t>(geometry.rows) * static_cast<std::size_t>(geometry.columns)),
      tile_columns_(tiles_across(geometry.columns, kTileColumns)),
      tile_rows_(tiles_across(geometry.rows, kTileRows)),
      states_(tile_columns_ * tile_rows_) {}

CellWindow TerrainTiles::window_of(std::size_t tile) const {
  const int row = static_cast<int>(tile / tile_columns_) * kTileRows;
  const int column = static_cast<int>(tile % tile_columns_) * kTileColumns;
  return {row, column, std::min(kTileRows, geometry_.rows - row),
          std::min(kTileColumns, geometry_.columns - column)};
}

TerrainTiles::State TerrainTiles::read(std::size_t tile) const {
  const std::lock_guard lock(reading_);
  if (const auto now = static_cast<State>(states_[tile].load()); now != kUnread) return now;
  const CellWindow window = window_of(tile);
  const auto cells = static_cast<std::size_t>(window.rows) * static_cast<std::size_t>(window.columns);
  std::vector<float> heights(cells);
  std::vector<std::uint8_t> valid(cells);
  if (Result<void> read = cells_->read(window, heights.data(), valid.data()); !read) {
    if (!damage_) damage_ = read.error();
    std::fill(valid.begin(), valid.end(), std::uint8_t{0});
  }
  for (int r = 0; r < window.rows; ++r) {
    const std::size_t from = static_cast<std::size_t>(r) * static_cast<std::size_t>(window.columns);
    const std::size_t to =
        static_cast<std::size_t>(window.row + r) * static_cast<std::size_t>(geometry_.columns) +
        static_cast<std::size_t>(window.column);
    std::copy_n(heights.data() + from, window.columns, heights_m_.data() + to);
    std::copy_n(valid.data() + from, window.columns, valid_.data() + to);
  }
  const bool whole = std::find(valid.begin(), valid.end(), std::uint8_t{0}) == valid.end();
  const State state = whole ? kWhole : kWithGaps;
  states_[tile].store(state, std::memory_order_release);
  return state;
}

bool TerrainTiles::need(int first_row, int first_column, int last_row, int last_column) const {
  const int top = std::clamp(first_row, 0, geometry_.rows - 1) / kTileRows;
  const int bottom = std::clamp(last_row, 0, geometry_.rows - 1) / kTileRows;
  const int left = std::clamp(first_column, 0, geometry_.columns - 1) / kTileColumns;
  const int right = std::clamp(last_column, 0, geometry_.columns - 1) / kTileColumns;
  bool whole = true;
  for (int row = top; row <= bottom; ++row) {
    for (int column = left; column <= right; ++column) {
      const std::size_t tile =
          static_cast<std::size_t>(row) * tile_columns_ + static_cast<std::size_t>(column);
      auto state = static_cast<State>(states_[tile].load(std::memory_order_acquire));
      if (state == kUnread) state = read(tile);
      whole &= state == kWhole;
    }
  }
  return whole;
}

bool TerrainTiles::read_part(const CellWindow& window, float* heights_m, std::uint8_t* valid) const {
  const Result<void> read = cells_->read(window, heights_m, valid);
  if (read) return true;
  const std::lock_guard lock(reading_);
  if (!damage_) damage_ = read.error();
  return false;
}

std::optional<Error> TerrainTiles::damage() const {
  const std::lock_guard lock(reading_);
  return damage_;
}

std::vector<CellWindow> TerrainTiles::read_tiles() const {
  std::vector<CellWindow> windows;
  for (std::size_t tile = 0; tile < states_.size(); ++tile)
    if (states_[tile].load(std::memory_order_acquire) != kUnread) windows.push_back(window_of(tile));
  return windows;
}

}  // namespace slipway::dem
