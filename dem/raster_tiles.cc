#include "dem/raster_tiles.h"

#include <algorithm>
#include <cstring>

namespace slipway::dem {
namespace {

constexpr std::size_t kSide = kTileSide;

// Of up to four values.
template <class Value>
Value coarser_value(const std::array<Value, 4>& under, int inside, Value nodata, Coarser how) {
  std::array<Value, 4> known{};
  int count = 0;
  for (int i = 0; i < inside; ++i)
    if (under[static_cast<std::size_t>(i)] != nodata)
      known[static_cast<std::size_t>(count++)] = under[static_cast<std::size_t>(i)];
  // At the raster's edge there are fewer than four.
  if (count == 0 || 2 * count < inside + (inside == 4 ? 1 : 0)) return nodata;
  std::sort(known.begin(), known.begin() + count);
  if (how == Coarser::kGreatest) return known[static_cast<std::size_t>(count - 1)];
  Value commonest = known[0];
  int most = 0;
  for (int i = 0; i < count; ++i) {
    const auto times = static_cast<int>(
        std::count(known.begin(), known.begin() + count, known[static_cast<std::size_t>(i)]));
    if (times > most) {
      most = times;
      commonest = known[static_cast<std::size_t>(i)];
    }
  }
  return commonest;
}

// Fills one quarter of a coarser tile from one finer tile.
template <class Value>
void reduce(const RasterLayer& layer, const LevelSize& finer, const TileIndex& from,
            const std::vector<std::uint8_t>& bytes, int down, int right, std::vector<std::uint8_t>& out) {
  std::vector<Value> cells(kSide * kSide);
  std::memcpy(cells.data(), bytes.data(), cells.size() * sizeof(Value));
  const auto nodata = static_cast<Value>(layer.nodata);
  auto* const target = reinterpret_cast<Value*>(out.data());
  const int rows = std::min(kTileSide, finer.rows - from.row * kTileSide);
  const int columns = std::min(kTileSide, finer.columns - from.column * kTileSide);
  for (int r = 0; r < rows; r += 2) {
    for (int c = 0; c < columns; c += 2) {
      std::array<Value, 4> under{};
      int inside = 0;
      for (int dr = 0; dr < 2 && r + dr < rows; ++dr)
        for (int dc = 0; dc < 2 && c + dc < columns; ++dc)
          under[static_cast<std::size_t>(inside++)] =
              cells[static_cast<std::size_t>(r + dr) * kSide + static_cast<std::size_t>(c + dc)];
      const std::size_t row = static_cast<std::size_t>(down * kTileSide / 2 + r / 2);
      const std::size_t column = static_cast<std::size_t>(right * kTileSide / 2 + c / 2);
      target[row * kSide + column] = coarser_value(under, inside, nodata, layer.coarser);
    }
  }
}

}  // namespace

LevelSize size_of_level(const GridGeometry& geometry, int level) {
  LevelSize size{geometry.rows, geometry.columns};
  for (int i = 0; i < level; ++i) size = {(size.rows + 1) / 2, (size.columns + 1) / 2};
  return size;
}

int levels_of(const GridGeometry& geometry) {
  int levels = 1;
  for (LevelSize size{geometry.rows, geometry.columns}; std::max(size.rows, size.columns) > kTileSide;
       size = {(size.rows + 1) / 2, (size.columns + 1) / 2})
    ++levels;
  return levels;
}

bool MemoryTiles::has(const TileIndex& tile) const {
  const std::lock_guard lock(mutex_);
  return tiles_.contains(tile);
}

Result<void> MemoryTiles::write(const TileIndex& tile, const std::vector<std::uint8_t>& bytes) {
  const std::lock_guard lock(mutex_);
  tiles_[tile] = bytes;
  return {};
}

Result<std::vector<std::uint8_t>> MemoryTiles::read(const TileIndex& tile) const {
  const std::lock_guard lock(mutex_);
  const auto found = tiles_.find(tile);
  if (found == tiles_.end()) return fail(ErrorCode::kInternal, "a tile of the raster is missing");
  return found->second;
}

Result<void> write_coarser_tile(const RasterLayer& layer, const TileIndex& tile, TileStore& store) {
  const LevelSize finer = size_of_level(layer.geometry, tile.level - 1);
  std::vector<std::uint8_t> out(kSide * kSide * layer.cell_bytes());
  if (layer.of_classes) {
    std::fill(out.begin(), out.end(), static_cast<std::uint8_t>(layer.nodata));
  } else {
    std::fill_n(reinterpret_cast<float*>(out.data()), kSide * kSide, static_cast<float>(layer.nodata));
  }
  for (const int down : {0, 1}) {
    for (const int right : {0, 1}) {
      const TileIndex from{tile.level - 1, 2 * tile.row + down, 2 * tile.column + right};
      if (from.row >= finer.tile_rows() || from.column >= finer.tile_columns()) continue;
      const auto bytes = store.read(from);
      if (!bytes) return fail(bytes.error());
      if (layer.of_classes)
        reduce<std::uint8_t>(layer, finer, from, *bytes, down, right, out);
      else
        reduce<float>(layer, finer, from, *bytes, down, right, out);
    }
  }
  return store.write(tile, out);
}

}  // namespace slipway::dem
