#pragma once

#include <filesystem>
#include <vector>

#include "random_stream.h"

namespace slipway::gap_benchmark {

// Heights on cell centres of a square grid about the origin, x east, y north.
class TerrainGrid {
 public:
  TerrainGrid(int cells, double cell_m)
      : cells_(cells), cell_m_(cell_m), height_m_(static_cast<std::size_t>(cells) * cells) {}

  int cells() const { return cells_; }
  double half_m() const { return 0.5 * cells_ * cell_m_; }
  double cell_m() const { return cell_m_; }
  std::vector<float>& heights() { return height_m_; }
  const std::vector<float>& heights() const { return height_m_; }
  double x_of(int column) const { return (column + 0.5) * cell_m_ - half_m(); }
  double y_of(int row) const { return half_m() - (row + 0.5) * cell_m_; }

  // Bilinear between centres.
  double height_at(double x_m, double y_m) const;
  bool inside(double x_m, double y_m, double margin_m) const;

 private:
  int cells_;
  double cell_m_;
  std::vector<float> height_m_;
};

// A plane that rises east.
TerrainGrid tilted_plane(double tilt_deg);

// Smooth hills whose slopes have a median near 10 deg and hardly exceed 22 deg.
TerrainGrid hills(RandomStream& random);

// A GeoTIFF of 32-bit floats without a reference system.
bool write_geotiff(const TerrainGrid& grid, const std::filesystem::path& file);

}  // namespace slipway::gap_benchmark
