#include "dem/grid_geometry.h"

#include <algorithm>
#include <cmath>

namespace slipway::dem {
namespace {

// Edges that were computed as west + column * cell come back a rounding error away from a whole number; a map
// in metres 8,000 km from its origin carries 1e-9 m. Nearer than this share of a cell to an edge is on the
// edge.
constexpr double kOnEdge = 1e-6;

double snapped(double index) {
  const double whole = std::round(index);
  return std::abs(index - whole) < kOnEdge ? whole : index;
}

struct Span {
  int first = 0;
  int count = 0;
};

// The cells [first, first + count) of [0, cells) that meet [low, high], counted in cells from the outer edge.
Span meeting(double low, double high, int cells) {
  const double size = cells;
  low = snapped(low);
  high = snapped(high);
  if (!(low <= high) || high < 0.0 || low > size) return {};
  double first = std::floor(low);
  double last = std::ceil(high);
  // An interval without length on an edge belongs to the cell after it, on the outer edge to the last cell.
  if (first == last) {
    first = std::min(first, size - 1.0);
    last = first + 1.0;
  }
  first = std::clamp(first, 0.0, size);
  last = std::clamp(last, 0.0, size);
  return {static_cast<int>(first), static_cast<int>(last - first)};
}

}  // namespace

Extent GridGeometry::extent() const {
  return {.west_m = west_m,
          .south_m = north_m - rows * cell_y_m,
          .east_m = west_m + columns * cell_x_m,
          .north_m = north_m};
}

Eigen::Vector2d GridGeometry::centre_m(const Cell& cell) const {
  return {west_m + (cell.column + 0.5) * cell_x_m, north_m - (cell.row + 0.5) * cell_y_m};
}

Eigen::Vector2d GridGeometry::fractional_index(double x_m, double y_m) const {
  return {(north_m - y_m) / cell_y_m - 0.5, (x_m - west_m) / cell_x_m - 0.5};
}

std::optional<Cell> GridGeometry::cell_at(double x_m, double y_m) const {
  if (rows < 1 || columns < 1 || !extent().contains(x_m, y_m)) return std::nullopt;
  const int row = static_cast<int>(std::floor((north_m - y_m) / cell_y_m));
  const int column = static_cast<int>(std::floor((x_m - west_m) / cell_x_m));
  return Cell{std::clamp(row, 0, rows - 1), std::clamp(column, 0, columns - 1)};
}

std::optional<CellWindow> GridGeometry::window(const Extent& extent) const {
  const Span down =
      meeting((north_m - extent.north_m) / cell_y_m, (north_m - extent.south_m) / cell_y_m, rows);
  const Span right =
      meeting((extent.west_m - west_m) / cell_x_m, (extent.east_m - west_m) / cell_x_m, columns);
  if (down.count < 1 || right.count < 1) return std::nullopt;
  return CellWindow{down.first, right.first, down.count, right.count};
}

GridGeometry GridGeometry::sub(const CellWindow& window) const {
  return {.rows = window.rows,
          .columns = window.columns,
          .west_m = west_m + window.column * cell_x_m,
          .north_m = north_m - window.row * cell_y_m,
          .cell_x_m = cell_x_m,
          .cell_y_m = cell_y_m};
}

}  // namespace slipway::dem
