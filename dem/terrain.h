#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/result.h"
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

// Reads cells of a raster for a terrain that holds only those which were looked at. Thread-safe.
class CellReader {
 public:
  virtual ~CellReader() = default;
  // The heights (m) of the window of the terrain's own cells and which of them have one, rows * columns
  // values each. Error: unreadable_raster.
  virtual Result<void> read(const CellWindow& window, float* heights_m, std::uint8_t* valid) const = 0;
};

class TerrainTiles;

// An elevation window in memory: immutable, shared by pointer between threads. Heights live at cell centres
// and are joined bilinearly; a missing cell is masked, and a point that needs a missing cell has no height.
class Terrain {
 public:
  // heights_m and valid have rows * columns values, row by row from the north. valid[i] == 0 marks a missing
  // cell, whose height is never read. Throws std::invalid_argument where the sizes do not agree or a valid
  // cell has no finite height.
  Terrain(GridGeometry geometry, std::vector<float> heights_m, std::vector<std::uint8_t> valid);
  // Of any size: its cells are read by tiles when they are first looked at, and memory is that of these
  // tiles. What a caller sees is the same as if all had been read. A tile that can't be read has no data, see
  // damage().
  Terrain(GridGeometry geometry, std::shared_ptr<const CellReader> cells);
  ~Terrain();
  Terrain(const Terrain&) = delete;
  Terrain& operator=(const Terrain&) = delete;

  const GridGeometry& geometry() const { return geometry_; }
  // Its cells are read when they are looked at.
  bool is_read_by_tiles() const { return tiles_ != nullptr; }
  // Why a tile could not be read; empty where all could that were looked at.
  std::optional<Error> damage() const;
  // A part of it as a terrain of its own, which holds all its cells. Of a terrain that is read by tiles they
  // are read anew and none is kept here: for one pass over more cells than memory should hold. Nothing where
  // they can't be read.
  std::shared_ptr<const Terrain> part(const CellWindow& window) const;
  // The height of the window's first cell, the next row geometry().columns behind it; nullptr where a cell of
  // it is masked or outside. Valid as long as the terrain.
  const float* heights_in(const CellWindow& window) const;
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

  // A hash over geometry, mask and heights, for provenance: 16 hexadecimal digits. Of a terrain that is read
  // by tiles, over those that were looked at.
  std::string fingerprint() const;

 private:
  std::size_t index_of(const Cell& cell) const;
  std::optional<Eigen::Vector2d> gradient_at(const Cell& cell) const;
  SurfacePoint surface_inside(int row, int column, double down, double right) const;

  // The cells that a look at this one needs, the neighbours' neighbours included, are read.
  void need(int row, int column) const;
  bool whole_around(int row, int column) const;

  GridGeometry geometry_;
  std::vector<float> held_heights_m_;
  std::vector<std::uint8_t> held_valid_;
  std::unique_ptr<TerrainTiles> tiles_;  // instead of those two
  const float* heights_m_ = nullptr;
  const std::uint8_t* valid_ = nullptr;
  bool whole_ = true;  // no cell is masked
};

}  // namespace slipway::dem
