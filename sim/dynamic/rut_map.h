#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace slipway::sim {

// The ruts in the ground: the depth to which wheels have pressed each place, on a grid of small cells in the
// map frame, stored in tiles where there are ruts. The deepest passage counts.
class RutMap {
 public:
  static constexpr int kTileCells = 32;  // cells along a tile's side

  explicit RutMap(double cell_m = 0.02);

  struct Rut {
    double depth_m = 0.0;  // under load, below the undisturbed surface; 0 where nothing has driven
    double share = 0.0;    // of the ground there that has been driven on, in [0, 1]
  };
  // Both values are bilinear between cells. The mean depth of the driven part alone is depth_m / share.
  Rut at(double x_m, double y_m) const;

  // Presses the track of a wheel of this width that went from one place to another at this depth. It covers
  // the cells whose centres the wheel passed over, and half a cell behind, so that no gaps remain between
  // steps around a bend. It does nothing without length or depth. The track's direction is taken from the two
  // places, so that steps much shorter than a cell should be given together.
  void press(const Eigen::Vector2d& from, const Eigen::Vector2d& to, double width_m, double depth_m);

  // Removes tiles that lie wholly farther than this from the place, which bounds the memory on a long drive.
  void forget_beyond(const Eigen::Vector2d& place, double distance_m);

  struct Cell {
    double x_m = 0.0, y_m = 0.0;  // its centre
    double depth_m = 0.0;
  };
  // All pressed cells, in an order that depends on the drive alone.
  std::vector<Cell> cells() const;
  double cell_m() const { return cell_m_; }
  std::size_t tile_count() const { return tiles_.size(); }

 private:
  struct Tile {
    float depth_m[kTileCells * kTileCells] = {};  // 0 where it was never pressed
  };
  float depth(std::int64_t column, std::int64_t row) const;
  Eigen::Vector2d centre(std::int64_t column, std::int64_t row) const;

  double cell_m_, per_cell_;
  std::unordered_map<std::uint64_t, Tile> tiles_;
};

}  // namespace slipway::sim
