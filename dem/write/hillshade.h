#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "core/result.h"
#include "dem/terrain.h"

namespace slipway::dem {

// Lambert shading of a terrain, one grey value a cell from the north-west [Horn 1981]; 0 marks a masked cell.
// sun_azimuth_rad clockwise from north, sun_elevation_rad above the horizon.
std::vector<std::uint8_t> hillshade(const Terrain& terrain, double sun_azimuth_rad, double sun_elevation_rad,
                                    double vertical_exaggeration);

// The unit vector towards a sun, and the light on a surface with this normal, in [0, 1].
Eigen::Vector3d towards_sun(double azimuth_rad, double elevation_rad);
double light_on(const Eigen::Vector3d& normal, const Eigen::Vector3d& sun, double vertical_exaggeration);
// The same of a surface by how it rises to the east and to the north, m/m.
inline float light_on_gradient(const Eigen::Vector2f& rise, const Eigen::Vector3d& sun,
                               float vertical_exaggeration) {
  const Eigen::Vector2f stretched = vertical_exaggeration * rise;
  const float towards = static_cast<float>(sun.z()) - stretched.dot(sun.head<2>().cast<float>());
  return std::clamp(towards / std::sqrt(1.0F + stretched.squaredNorm()), 0.0F, 1.0F);
}

// An 8-bit grey image as a PNG file in memory. pixels: rows * columns values.
Result<std::string> encode_png(const std::vector<std::uint8_t>& grey, int rows, int columns);

}  // namespace slipway::dem
