#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace slipway::sim {

// What wheels have left in the ground: how deep each place was pressed, on a grid of small cells in the map
// frame, kept in tiles where there are any. Only the deepest passage counts.
class RutMap {
 public:
  static constexpr int kTileCells = 32;  // a side

  explicit RutMap(double cell_m = 0.02);

  struct Rut {
    double depth_m = 0.0;  // under load, below the undisturbed surface; 0 where nothing has driven
    double share = 0.0;    // of the ground there that has been driven on, in [0, 1]
  };
  // Both bilinear between cells: where the driven part alone is asked for, its depth is depth_m / share.
  Rut at(double x_m, double y_m) const;

  // A wheel of this width went from one place to another, pressed to this depth: cells whose centres it
  // passed over and, so that no gaps stay between steps around a bend, half a cell behind. Nothing without
  // way or depth; its direction is the wheel's own, so steps much shorter than a cell are better given
  // together.
  void press(const Eigen::Vector2d& from, const Eigen::Vector2d& to, double width_m, double depth_m);

  // Forgets tiles that lie wholly farther than this from the place: keeps memory flat on a long drive.
  void forget_beyond(const Eigen::Vector2d& place, double distance_m);

  struct Cell {
    double x_m = 0.0, y_m = 0.0;  // its centre
    double depth_m = 0.0;
  };
  // All cells pressed, in an order that depends on the drive alone.
  std::vector<Cell> cells() const;
  double cell_m() const { return cell_m_; }
  std::size_t tile_count() const { return tiles_.size(); }

 private:
  struct Tile {
    float depth_m[kTileCells * kTileCells] = {};  // 0: never pressed
  };
  float depth(std::int64_t column, std::int64_t row) const;
  Eigen::Vector2d centre(std::int64_t column, std::int64_t row) const;

  double cell_m_, per_cell_;
  std::unordered_map<std::uint64_t, Tile> tiles_;
};

}  // namespace slipway::sim
