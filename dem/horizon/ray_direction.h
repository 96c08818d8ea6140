#pragma once

#include <Eigen/Core>
#include <cmath>

#include "dem/grid_geometry.h"

namespace slipway::dem {

// Rows and columns of a metre of a ray, `azimuth_rad` clockwise from north. Along a row or a column the trace
// of the other that rounding leaves is taken away: such a ray would creep along the border of two cells.
inline Eigen::Vector2d index_per_m(const GridGeometry& grid, double azimuth_rad) {
  const auto cleared = [](double per_m) { return std::abs(per_m) < 1e-10 ? 0.0 : per_m; };
  return {cleared(-std::cos(azimuth_rad) / grid.cell_y_m), cleared(std::sin(azimuth_rad) / grid.cell_x_m)};
}

}  // namespace slipway::dem
