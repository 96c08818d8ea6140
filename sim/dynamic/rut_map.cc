#include "sim/dynamic/rut_map.h"

#include <algorithm>
#include <cmath>

namespace slipway::sim {
namespace {

constexpr std::int64_t kTileShift = 5;
constexpr std::int64_t kWithinTile = RutMap::kTileCells - 1;
static_assert(RutMap::kTileCells == 1 << kTileShift);

// The key of the tile that holds a cell, with the row in the upper bits; columns and rows must be within 2^36
// of the origin.
std::uint64_t tile_key(std::int64_t column, std::int64_t row) {
  return static_cast<std::uint64_t>(row >> kTileShift) << 32 |
         static_cast<std::uint32_t>(column >> kTileShift);
}

std::int64_t first_column(std::uint64_t key) {
  return std::int64_t{static_cast<std::int32_t>(key)} << kTileShift;
}

std::int64_t first_row(std::uint64_t key) {
  return std::int64_t{static_cast<std::int32_t>(key >> 32)} << kTileShift;
}

std::size_t cell_index(std::int64_t column, std::int64_t row) {
  return static_cast<std::size_t>((row & kWithinTile) << kTileShift | (column & kWithinTile));
}

std::int64_t floor_index(double value) {
  return static_cast<std::int64_t>(std::floor(value));
}

}  // namespace

RutMap::RutMap(double cell_m) : cell_m_(cell_m), per_cell_(1.0 / cell_m) {}

float RutMap::depth(std::int64_t column, std::int64_t row) const {
  const auto tile = tiles_.find(tile_key(column, row));
  return tile == tiles_.end() ? 0.0f : tile->second.depth_m[cell_index(column, row)];
}

RutMap::Rut RutMap::at(double x_m, double y_m) const {
  // The lower left of the four cells whose centres are around the place, and the place's fraction of the
  // distance to the next centres.
  const double x = x_m * per_cell_ - 0.5, y = y_m * per_cell_ - 0.5;
  const std::int64_t column = floor_index(x), row = floor_index(y);
  const double right = x - static_cast<double>(column), up = y - static_cast<double>(row);
  float around[4];
  if ((column & kWithinTile) != kWithinTile && (row & kWithinTile) != kWithinTile) {
    const auto tile = tiles_.find(tile_key(column, row));
    if (tile == tiles_.end()) return {};
    const float* lower = tile->second.depth_m + cell_index(column, row);
    around[0] = lower[0];
    around[1] = lower[1];
    around[2] = lower[kTileCells];
    around[3] = lower[kTileCells + 1];
  } else {
    for (int i = 0; i < 4; ++i) around[i] = depth(column + (i & 1), row + (i >> 1));
  }
  const double weight[4] = {(1.0 - right) * (1.0 - up), right * (1.0 - up), (1.0 - right) * up, right * up};
  Rut rut;
  for (int i = 0; i < 4; ++i) {
    rut.depth_m += weight[i] * around[i];
    rut.share += around[i] > 0.0f ? weight[i] : 0.0;
  }
  return rut;
}

void RutMap::press(const Eigen::Vector2d& from, const Eigen::Vector2d& to, double width_m, double depth_m) {
  const Eigen::Vector2d way = to - from;
  const double length = way.norm();
  if (!(length > 0.0) || !(depth_m > 0.0)) return;
  const Eigen::Vector2d along = way / length, left(-along.y(), along.x());
  const double behind = 0.5 * cell_m_, half_width = 0.5 * width_m;
  const Eigen::Vector2d middle = 0.5 * (from + to - behind * along);
  const Eigen::Vector2d reach = 0.5 * (length + behind) * along.cwiseAbs() + half_width * left.cwiseAbs();
  const Eigen::Vector2d low = (middle - reach) * per_cell_, high = (middle + reach) * per_cell_;
  for (std::int64_t row = floor_index(low.y()); row <= floor_index(high.y()); ++row) {
    for (std::int64_t column = floor_index(low.x()); column <= floor_index(high.x()); ++column) {
      const Eigen::Vector2d place = centre(column, row) - from;
      const double done = place.dot(along);
      if (done < -behind || done > length || std::abs(place.dot(left)) > half_width) continue;
      float& deepest = tiles_[tile_key(column, row)].depth_m[cell_index(column, row)];
      deepest = std::max(deepest, static_cast<float>(depth_m));
    }
  }
}

void RutMap::forget_beyond(const Eigen::Vector2d& place, double distance_m) {
  const double side = kTileCells * cell_m_;
  std::erase_if(tiles_, [&](const auto& entry) {
    const Eigen::Vector2d corner = cell_m_ * Eigen::Vector2d(static_cast<double>(first_column(entry.first)),
                                                             static_cast<double>(first_row(entry.first)));
    const Eigen::Vector2d nearest = place.cwiseMax(corner).cwiseMin(corner + Eigen::Vector2d(side, side));
    return (nearest - place).norm() > distance_m;
  });
}

std::vector<RutMap::Cell> RutMap::cells() const {
  std::vector<std::uint64_t> keys;
  keys.reserve(tiles_.size());
  for (const auto& [key, tile] : tiles_) keys.push_back(key);
  std::sort(keys.begin(), keys.end());
  std::vector<Cell> pressed;
  for (const std::uint64_t key : keys) {
    const Tile& tile = tiles_.at(key);
    for (int i = 0; i < kTileCells * kTileCells; ++i) {
      if (!(tile.depth_m[i] > 0.0f)) continue;
      const Eigen::Vector2d p = centre(first_column(key) + i % kTileCells, first_row(key) + i / kTileCells);
      pressed.push_back({p.x(), p.y(), tile.depth_m[i]});
    }
  }
  return pressed;
}

Eigen::Vector2d RutMap::centre(std::int64_t column, std::int64_t row) const {
  return {(static_cast<double>(column) + 0.5) * cell_m_, (static_cast<double>(row) + 0.5) * cell_m_};
}

}  // namespace slipway::sim
