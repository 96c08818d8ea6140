#include "dem/gradient_field.h"

#include <algorithm>
#include <cmath>

namespace slipway::dem {
namespace {

BetweenCentres between(double index, int count) {
  BetweenCentres place;
  place.inside = index >= -0.5 && index <= count - 0.5;
  const double held = std::clamp(index, 0.0, count - 1.0);
  place.first = static_cast<int>(held);
  place.second = std::min(place.first + 1, count - 1);
  place.share = static_cast<float>(held - place.first);
  return place;
}

}  // namespace

GradientField::GradientField(const GridGeometry& geometry)
    : geometry_(geometry),
      columns_(static_cast<std::size_t>(geometry.columns)),
      gradients_(static_cast<std::size_t>(geometry.rows) * columns_) {}

std::optional<GradientField> GradientField::of(const Terrain& terrain) {
  const GridGeometry& geometry = terrain.geometry();
  if (geometry.rows < 2 || geometry.columns < 2) return std::nullopt;
  const float* const heights =
      terrain.heights_in({.row = 0, .column = 0, .rows = geometry.rows, .columns = geometry.columns});
  if (heights == nullptr) return std::nullopt;
  GradientField field(geometry);
  for (int row = 0; row < geometry.rows; ++row) {
    // At an edge a difference is one-sided.
    const int north = std::max(row - 1, 0), south = std::min(row + 1, geometry.rows - 1);
    const auto row_of = [&](int r) { return heights + static_cast<std::size_t>(r) * field.columns_; };
    const float *const here = row_of(row), *const above = row_of(north), *const below = row_of(south);
    const double per_north_m = 1.0 / ((south - north) * geometry.cell_y_m);
    Eigen::Vector2f* const out = &field.gradients_[static_cast<std::size_t>(row) * field.columns_];
    for (int column = 0; column < geometry.columns; ++column) {
      const int west = std::max(column - 1, 0), east = std::min(column + 1, geometry.columns - 1);
      const double per_east_m = 1.0 / ((east - west) * geometry.cell_x_m);
      out[column] = {
          static_cast<float>((static_cast<double>(here[east]) - static_cast<double>(here[west])) *
                             per_east_m),
          static_cast<float>((static_cast<double>(above[column]) - static_cast<double>(below[column])) *
                             per_north_m)};
    }
  }
  return field;
}

BetweenCentres GradientField::row_at(double y_m) const {
  return between(geometry_.fractional_index(geometry_.west_m, y_m)[0], geometry_.rows);
}

BetweenCentres GradientField::column_at(double x_m) const {
  return between(geometry_.fractional_index(x_m, geometry_.north_m)[1], geometry_.columns);
}

}  // namespace slipway::dem
