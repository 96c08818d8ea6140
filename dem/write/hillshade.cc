#include "dem/write/hillshade.h"

#include <algorithm>
#include <cmath>

namespace slipway::dem {

Eigen::Vector3d towards_sun(double azimuth_rad, double elevation_rad) {
  return {std::cos(elevation_rad) * std::sin(azimuth_rad), std::cos(elevation_rad) * std::cos(azimuth_rad),
          std::sin(elevation_rad)};
}

double light_on(const Eigen::Vector3d& normal, const Eigen::Vector3d& sun, double vertical_exaggeration) {
  const Eigen::Vector3d stretched(vertical_exaggeration * normal.x(), vertical_exaggeration * normal.y(),
                                  normal.z());
  return std::clamp(stretched.normalized().dot(sun), 0.0, 1.0);
}

std::vector<std::uint8_t> hillshade(const Terrain& terrain, double sun_azimuth_rad, double sun_elevation_rad,
                                    double vertical_exaggeration) {
  const Eigen::Vector3d sun = towards_sun(sun_azimuth_rad, sun_elevation_rad);
  const GridGeometry& geometry = terrain.geometry();
  std::vector<std::uint8_t> grey;
  grey.reserve(static_cast<std::size_t>(geometry.rows) * static_cast<std::size_t>(geometry.columns));
  for (int row = 0; row < geometry.rows; ++row) {
    for (int column = 0; column < geometry.columns; ++column) {
      const Cell cell{row, column};
      if (!terrain.has_data(cell)) {
        grey.push_back(0);
        continue;
      }
      // A cell without a neighbour has no slope; it is drawn level.
      const Eigen::Vector3d normal = terrain.surface(cell).value_or(SurfacePoint{}).normal;
      const double light = light_on(normal, sun, vertical_exaggeration);
      // 0 is kept for masked cells, so that full shadow is 1.
      grey.push_back(static_cast<std::uint8_t>(std::lround(1.0 + 254.0 * light)));
    }
  }
  return grey;
}

}  // namespace slipway::dem
