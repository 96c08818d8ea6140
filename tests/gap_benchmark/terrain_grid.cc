#include "terrain_grid.h"

#include <algorithm>
#include <cmath>

namespace slipway::gap_benchmark {

double TerrainGrid::height_at(double x_m, double y_m) const {
  const double limit = cells_ - 1.000001;
  const double column = std::clamp((x_m + half_m()) / cell_m_ - 0.5, 0.0, limit);
  const double row = std::clamp((half_m() - y_m) / cell_m_ - 0.5, 0.0, limit);
  const int j = static_cast<int>(column), i = static_cast<int>(row);
  const double u = column - j, v = row - i;
  const auto at = [&](int r, int c) {
    return static_cast<double>(height_m_[static_cast<std::size_t>(r) * static_cast<std::size_t>(cells_) +
                                         static_cast<std::size_t>(c)]);
  };
  return (1.0 - v) * ((1.0 - u) * at(i, j) + u * at(i, j + 1)) +
         v * ((1.0 - u) * at(i + 1, j) + u * at(i + 1, j + 1));
}

bool TerrainGrid::inside(double x_m, double y_m, double margin_m) const {
  return std::max(std::abs(x_m), std::abs(y_m)) < half_m() - margin_m;
}

TerrainGrid tilted_plane(double tilt_deg) {
  TerrainGrid grid(160, 0.1);
  const double rise = std::tan(tilt_deg * std::numbers::pi / 180.0);
  for (int i = 0; i < grid.cells(); ++i)
    for (int j = 0; j < grid.cells(); ++j)
      grid.heights()[static_cast<std::size_t>(i * grid.cells() + j)] =
          static_cast<float>(rise * grid.x_of(j));
  return grid;
}

TerrainGrid hills(RandomStream& random) {
  TerrainGrid grid(400, 0.1);
  struct Wave {
    double kx, ky, phase, height;
  };
  std::vector<Wave> waves;
  for (int w = 0; w < 14; ++w) {
    const double length = random.uniform(7.0, 22.0), direction = random.uniform(0.0, 2.0 * std::numbers::pi);
    const double k = 2.0 * std::numbers::pi / length;
    waves.push_back({k * std::cos(direction), k * std::sin(direction),
                     random.uniform(0.0, 2.0 * std::numbers::pi), 0.02 * length * random.uniform(0.5, 1.5)});
  }
  const auto height = [&](double x, double y) {
    double z = 0.0;
    for (const Wave& wave : waves) z += wave.height * std::sin(wave.kx * x + wave.ky * y + wave.phase);
    return z;
  };
  std::vector<double> slopes;
  constexpr double kStep = 0.05;
  for (double x = -19.0; x <= 19.0; x += 0.5)
    for (double y = -19.0; y <= 19.0; y += 0.5)
      slopes.push_back(std::hypot(height(x + kStep, y) - height(x - kStep, y),
                                  height(x, y + kStep) - height(x, y - kStep)) /
                       (2.0 * kStep));
  std::sort(slopes.begin(), slopes.end());
  const double steepest = slopes[slopes.size() * 99 / 100];
  const double scale = std::tan(20.5 * std::numbers::pi / 180.0) / steepest;
  for (int i = 0; i < grid.cells(); ++i)
    for (int j = 0; j < grid.cells(); ++j)
      grid.heights()[static_cast<std::size_t>(i * grid.cells() + j)] =
          static_cast<float>(scale * height(grid.x_of(j), grid.y_of(i)));
  return grid;
}

}  // namespace slipway::gap_benchmark
