#include "dem/hillshade.h"

#include <algorithm>
#include <cmath>

namespace slipway::dem {

std::vector<std::uint8_t> hillshade(const Terrain& terrain, double sun_azimuth_rad, double sun_elevation_rad,
                                    double vertical_exaggeration) {
  const Eigen::Vector3d towards_sun(std::cos(sun_elevation_rad) * std::sin(sun_azimuth_rad),
                                    std::cos(sun_elevation_rad) * std::cos(sun_azimuth_rad),
                                    std::sin(sun_elevation_rad));
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
      const Eigen::Vector3d stretched(vertical_exaggeration * normal.x(), vertical_exaggeration * normal.y(),
                                      normal.z());
      const double light = std::max(0.0, stretched.normalized().dot(towards_sun));
      // 0 is kept for masked cells, so that full shadow is 1.
      grey.push_back(static_cast<std::uint8_t>(std::lround(1.0 + 254.0 * std::min(light, 1.0))));
    }
  }
  return grey;
}

}  // namespace slipway::dem
