#pragma once

#include <Eigen/Core>
#include <optional>

namespace slipway::dem {

// An axis-aligned rectangle in the map frame M.
struct Extent {
  double west_m = 0.0;
  double south_m = 0.0;
  double east_m = 0.0;
  double north_m = 0.0;

  bool contains(double x_m, double y_m) const {
    return x_m >= west_m && x_m <= east_m && y_m >= south_m && y_m <= north_m;
  }
  bool operator==(const Extent&) const = default;
};

// A cell of a raster, frame I: row down (south), column right (east).
struct Cell {
  int row = 0;
  int column = 0;

  bool operator==(const Cell&) const = default;
};

// A rectangle of cells [row, row + rows) x [column, column + columns).
struct CellWindow {
  int row = 0;
  int column = 0;
  int rows = 0;
  int columns = 0;

  bool operator==(const CellWindow&) const = default;
};

// Where a north-up raster lies on the map. THE CELL-CENTRE RULE, written only here: cell (0, 0) is the
// north-west cell, (west_m, north_m) is its outer corner, and a cell's value belongs to its centre. In
// fractional indices (row, column) the centre of a cell has whole numbers; the raster's outer corner is
// (-0.5, -0.5).
struct GridGeometry {
  int rows = 0;
  int columns = 0;
  double west_m = 0.0;    // outer edge
  double north_m = 0.0;   // outer edge
  double cell_x_m = 1.0;  // width of a cell, > 0
  double cell_y_m = 1.0;  // height of a cell, > 0

  Extent extent() const;
  Eigen::Vector2d centre_m(const Cell& cell) const;
  // (row, column) as fractions, whole numbers at cell centres; also outside the raster.
  Eigen::Vector2d fractional_index(double x_m, double y_m) const;
  // The cell that holds the point; empty outside. A point on the south or east outer edge belongs to the last
  // cell.
  std::optional<Cell> cell_at(double x_m, double y_m) const;
  // The cells whose area meets the extent, clipped to the raster; empty where none does.
  std::optional<CellWindow> window(const Extent& extent) const;
  // The geometry of that window.
  GridGeometry sub(const CellWindow& window) const;

  bool operator==(const GridGeometry&) const = default;
};

}  // namespace slipway::dem
