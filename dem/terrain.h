#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "dem/grid_geometry.h"

namespace slipway::dem {

// The ground at a point, in the map frame M.
struct SurfacePoint {
  double height_m = 0.0;
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  // unit, upward

  double slope_rad() const;
  // Direction of steepest descent, clockwise from north in [0, 2 pi), as geographers count it; 0 on level
  // ground.
  double aspect_rad() const;
};

// An elevation window in memory: immutable, shared by pointer between threads. Heights live at cell centres
// and are joined bilinearly; a missing cell is masked, and a point that needs a missing cell has no height.
class Terrain {
 public:
  // heights_m and valid have rows * columns values, row by row from the north. valid[i] == 0 marks a missing
  // cell, whose height is never read. Throws std::invalid_argument where the sizes do not agree or a valid
  // cell has no finite height.
  Terrain(GridGeometry geometry, std::vector<float> heights_m, std::vector<std::uint8_t> valid);

  const GridGeometry& geometry() const { return geometry_; }
  bool has_data(const Cell& cell) const;
  // The height at the cell's centre; empty where the cell is masked or outside.
  std::optional<double> height_m(const Cell& cell) const;

  // The height, bilinear between the four nearest centres; within half a cell of the outer edge the edge
  // centres are extended. Empty outside the extent and where one of the four centres is masked.
  std::optional<double> height_m(double x_m, double y_m) const;
  // The height, and the normal of the bilinear blend of the four centres' central-difference gradients, which
  // makes the normal continuous. A masked neighbour makes a difference one-sided. Empty as above.
  std::optional<SurfacePoint> surface(double x_m, double y_m) const;
  // The same at a cell's centre. Empty where the cell is masked or outside, and where it has no neighbour
  // with data in a direction, since a single cell has no slope.
  std::optional<SurfacePoint> surface(const Cell& cell) const;
  // Root mean square distance (m) of the cell centres within radius_m to their least-squares plane; empty
  // with fewer than four centres with data.
  std::optional<double> roughness_m(double x_m, double y_m, double radius_m) const;

  // A hash over geometry, mask and heights, for provenance: 16 hexadecimal digits.
  std::string fingerprint() const;

 private:
  std::size_t index_of(const Cell& cell) const;
  std::optional<Eigen::Vector2d> gradient_at(const Cell& cell) const;
  SurfacePoint surface_inside(int row, int column, double down, double right) const;

  GridGeometry geometry_;
  std::vector<float> heights_m_;
  std::vector<std::uint8_t> valid_;
  bool whole_ = true;  // no cell is masked
};

}  // namespace slipway::dem
