#include "api/maps/map_tiles.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstring>
#include <mutex>
#include <optional>

#include "core/parallel_for.h"

namespace slipway::api {
namespace {

using dem::kTileSide;
using dem::TileIndex;

tl::unexpected<Error> map_given_up() {
  return fail(ErrorCode::kCancelled, "the map was given up");
}

// Values row by row, `columns` wide, as the bytes of a whole tile.
std::vector<std::uint8_t> tile_bytes(const std::vector<float>& values, int rows, int columns,
                                     const dem::RasterLayer& layer) {
  constexpr std::size_t kSide = kTileSide;
  std::vector<float> cells(kSide * kSide, static_cast<float>(layer.nodata));
  for (int r = 0; r < rows; ++r)
    std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(r) * columns, columns,
                cells.begin() + static_cast<std::ptrdiff_t>(r) * kTileSide);
  std::vector<std::uint8_t> bytes(cells.size() * layer.cell_bytes());
  if (layer.of_classes)
    std::transform(cells.begin(), cells.end(), bytes.begin(),
                   [](float value) { return static_cast<std::uint8_t>(value); });
  else
    std::memcpy(bytes.data(), cells.data(), bytes.size());
  return bytes;
}

// The first error of several threads.
class FirstError {
 public:
  void note(const Error& error) {
    const std::lock_guard lock(mutex_);
    if (!error_) error_ = error;
    failed_ = true;
  }
  bool failed() const { return failed_; }
  Result<void> result() const {
    if (error_) return fail(*error_);
    return {};
  }

 private:
  std::mutex mutex_;
  std::atomic<bool> failed_{false};
  std::optional<Error> error_;
};

// A square of tiles, as cells of the layer.
struct MapPiece {
  dem::CellWindow cells;
  std::vector<TileIndex> tiles;  // that are still to be made
};

std::vector<MapPiece> pieces_of(const dem::RasterLayer& layer, const dem::TileStore& store) {
  const dem::LevelSize size = dem::size_of_level(layer.geometry, 0);
  std::vector<MapPiece> pieces;
  for (int row = 0; row < size.tile_rows(); row += kTilesOfPiece) {
    for (int column = 0; column < size.tile_columns(); column += kTilesOfPiece) {
      MapPiece piece;
      piece.cells = {row * kTileSide, column * kTileSide,
                     std::min(kTilesOfPiece * kTileSide, size.rows - row * kTileSide),
                     std::min(kTilesOfPiece * kTileSide, size.columns - column * kTileSide)};
      for (int r = row; r < std::min(row + kTilesOfPiece, size.tile_rows()); ++r)
        for (int c = column; c < std::min(column + kTilesOfPiece, size.tile_columns()); ++c)
          if (!store.has({0, r, c})) piece.tiles.push_back({0, r, c});
      if (!piece.tiles.empty()) pieces.push_back(std::move(piece));
    }
  }
  return pieces;
}

Result<void> fill_piece(const planner::CellMap& map, const TerrainSite& site, const Legend& legend,
                        const dem::RasterLayer& layer, const MapPiece& piece, dem::TileStore& store) {
  const dem::GridGeometry& g = layer.geometry;
  const int margin = map.margin(g);
  dem::Extent extent = g.sub(piece.cells).extent();
  // Half a cell less, so that no rounding takes a further row.
  const double reach_x = (margin - 0.5) * g.cell_x_m, reach_y = (margin - 0.5) * g.cell_y_m;
  extent = {extent.west_m - reach_x, extent.south_m - reach_y, extent.east_m + reach_x,
            extent.north_m + reach_y};
  const auto ground = site.read(extent, legend);
  if (!ground) return fail(ground.error());
  const dem::GridGeometry& read = ground->terrain->geometry();
  for (const TileIndex& tile : piece.tiles) {
    const int row = tile.row * kTileSide, column = tile.column * kTileSide;
    const int rows = std::min(kTileSide, g.rows - row), columns = std::min(kTileSide, g.columns - column);
    const Eigen::Vector2d first = g.centre_m({row, column});
    const dem::CellWindow window{
        static_cast<int>(std::lround((read.north_m - first.y()) / read.cell_y_m - 0.5)),
        static_cast<int>(std::lround((first.x() - read.west_m) / read.cell_x_m - 0.5)), rows, columns};
    const std::vector<float> values =
        map.values(*ground->terrain, *ground->soil_map, window, site.info().geometry.extent());
    if (const auto written = store.write(tile, tile_bytes(values, rows, columns, layer)); !written)
      return written;
  }
  return {};
}

// Of some cells.
struct CellFigures {
  std::array<long long, 256> of_class{};
  long long values = 0;  // of a layer that has no classes
  double lowest = 0.0, highest = 0.0, sum = 0.0;

  void add(const CellFigures& other) {
    for (std::size_t k = 0; k < of_class.size(); ++k) of_class[k] += other.of_class[k];
    if (other.values == 0) return;
    lowest = values == 0 ? other.lowest : std::min(lowest, other.lowest);
    highest = values == 0 ? other.highest : std::max(highest, other.highest);
    values += other.values;
    sum += other.sum;
  }
};

CellFigures figures_of(const dem::RasterLayer& layer, const TileIndex& tile,
                       const std::vector<std::uint8_t>& bytes) {
  const int rows = std::min(kTileSide, layer.geometry.rows - tile.row * kTileSide);
  const int columns = std::min(kTileSide, layer.geometry.columns - tile.column * kTileSide);
  const auto nodata = static_cast<float>(layer.nodata);
  CellFigures found;
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < columns; ++c) {
      const std::size_t at = static_cast<std::size_t>(r) * kTileSide + static_cast<std::size_t>(c);
      if (layer.of_classes) {
        ++found.of_class[bytes[at]];
        continue;
      }
      float value = 0.0F;
      std::memcpy(&value, bytes.data() + at * sizeof value, sizeof value);
      if (value == nodata) continue;
      found.lowest = found.values == 0 ? value : std::min<double>(found.lowest, value);
      found.highest = found.values == 0 ? value : std::max<double>(found.highest, value);
      ++found.values;
      found.sum += value;
    }
  }
  return found;
}

}  // namespace

Result<void> fill_tiles(const planner::CellMap& map, const TerrainSite& site, const Legend& legend,
                        const dem::RasterLayer& layer, dem::TileStore& store, std::size_t threads,
                        Progress& progress) {
  const std::vector<MapPiece> pieces = pieces_of(layer, store);
  const dem::LevelSize size = dem::size_of_level(layer.geometry, 0);
  const double all = static_cast<double>(size.tile_rows()) * size.tile_columns();
  std::size_t left = 0;
  for (const MapPiece& piece : pieces) left += piece.tiles.size();
  std::atomic<std::size_t> done{0};
  FirstError first;
  parallel_for(pieces.size(), threads, [&](std::size_t i) {
    if (progress.cancelled() || first.failed()) return;
    const auto filled = fill_piece(map, site, legend, layer, pieces[i], store);
    if (!filled) first.note(filled.error());
    done += pieces[i].tiles.size();
    progress.report("computing tiles", (all - static_cast<double>(left - done)) / all);
  });
  if (progress.cancelled()) return map_given_up();
  return first.result();
}

Result<void> fill_tiles(const std::vector<float>& values, const dem::RasterLayer& layer,
                        dem::TileStore& store) {
  const dem::GridGeometry& g = layer.geometry;
  const dem::LevelSize size = dem::size_of_level(g, 0);
  for (int row = 0; row < size.tile_rows(); ++row) {
    for (int column = 0; column < size.tile_columns(); ++column) {
      const int rows = std::min(kTileSide, g.rows - row * kTileSide);
      const int columns = std::min(kTileSide, g.columns - column * kTileSide);
      std::vector<float> cells;
      for (int r = 0; r < rows; ++r) {
        const auto from = values.begin() + static_cast<std::ptrdiff_t>(row * kTileSide + r) * g.columns +
                          column * kTileSide;
        cells.insert(cells.end(), from, from + columns);
      }
      if (const auto written = store.write({0, row, column}, tile_bytes(cells, rows, columns, layer));
          !written)
        return written;
    }
  }
  return {};
}

Result<void> fill_coarser_levels(const dem::RasterLayer& layer, dem::TileStore& store, std::size_t threads,
                                 Progress& progress) {
  for (int level = 1; level < dem::levels_of(layer.geometry); ++level) {
    const dem::LevelSize size = dem::size_of_level(layer.geometry, level);
    const auto columns = static_cast<std::size_t>(size.tile_columns());
    FirstError first;
    parallel_for(columns * static_cast<std::size_t>(size.tile_rows()), threads, [&](std::size_t i) {
      if (progress.cancelled() || first.failed()) return;
      const TileIndex tile{level, static_cast<int>(i / columns), static_cast<int>(i % columns)};
      if (store.has(tile)) return;
      if (const auto written = dem::write_coarser_tile(layer, tile, store); !written)
        first.note(written.error());
    });
    if (progress.cancelled()) return map_given_up();
    if (auto failed = first.result(); !failed) return failed;
  }
  return {};
}

Result<MapStatistics> statistics_of(const dem::RasterLayer& layer, const dem::TileStore& store,
                                    std::size_t threads, const Progress& progress) {
  const dem::LevelSize size = dem::size_of_level(layer.geometry, 0);
  const auto columns = static_cast<std::size_t>(size.tile_columns());
  std::vector<CellFigures> tiles(columns * static_cast<std::size_t>(size.tile_rows()));
  FirstError first;
  parallel_for(tiles.size(), threads, [&](std::size_t i) {
    if (progress.cancelled() || first.failed()) return;
    const TileIndex tile{0, static_cast<int>(i / columns), static_cast<int>(i % columns)};
    const auto bytes = store.read(tile);
    if (bytes)
      tiles[i] = figures_of(layer, tile, *bytes);
    else
      first.note(bytes.error());
  });
  if (progress.cancelled()) return map_given_up();
  if (const auto read = first.result(); !read) return fail(read.error());
  CellFigures all;
  for (const CellFigures& tile : tiles) all.add(tile);
  MapStatistics found;
  found.cells = static_cast<long long>(layer.geometry.rows) * layer.geometry.columns;
  found.lowest = all.lowest;
  found.highest = all.highest;
  if (all.values > 0) found.mean = all.sum / static_cast<double>(all.values);
  long long values = all.values;
  for (const dem::RasterClass& each : layer.classes) {
    found.classes.emplace_back(each.name, all.of_class[each.value]);
    values += all.of_class[each.value];
  }
  found.nodata = found.cells - values;
  return found;
}

}  // namespace slipway::api
