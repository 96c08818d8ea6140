#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "dem/terrain.h"

namespace slipway::dem {

// Where a coordinate lies among the centres of rows or of columns.
struct BetweenCentres {
  int first = 0, second = 0;  // the centres; the same one within half a cell of the edge
  float share = 0.0F;         // of the second, in [0, 1)
  bool inside = false;        // the terrain's extent
};

// The gradients at the centres of a terrain whose cells all have data: what Terrain::surface blends, found
// once a cell and not at every point that is looked at. For pictures: single precision.
class GradientField {
 public:
  // Nothing where a cell is masked, or where there is a single row or column.
  static std::optional<GradientField> of(const Terrain& terrain);

  BetweenCentres row_at(double y_m) const;
  BetweenCentres column_at(double x_m) const;
  // Height gained per metre to the east and to the north, between the centres of a row and of a column.
  Eigen::Vector2f at(const BetweenCentres& row, const BetweenCentres& column) const {
    const Eigen::Vector2f* const upper = &gradients_[static_cast<std::size_t>(row.first) * columns_];
    const Eigen::Vector2f* const lower = &gradients_[static_cast<std::size_t>(row.second) * columns_];
    const Eigen::Vector2f above =
        upper[column.first] + column.share * (upper[column.second] - upper[column.first]);
    const Eigen::Vector2f below =
        lower[column.first] + column.share * (lower[column.second] - lower[column.first]);
    return above + row.share * (below - above);
  }

 private:
  explicit GradientField(const GridGeometry& geometry);

  GridGeometry geometry_;
  std::size_t columns_;
  std::vector<Eigen::Vector2f> gradients_;  // row by row
};

}  // namespace slipway::dem
