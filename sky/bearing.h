#pragma once

#include <Eigen/Core>
#include <cmath>
#include <numbers>

namespace slipway::sky {

// Where something in the sky stands, as seen from a place on a body.
struct Bearing {
  double azimuth_rad = 0.0;    // clockwise from north, [0, 2 pi)
  double elevation_rad = 0.0;  // above the level, without refraction
};

// Unit vector in the map frame: x east, y north, z up.
inline Eigen::Vector3d towards(const Bearing& bearing) {
  const double level = std::cos(bearing.elevation_rad);
  return {level * std::sin(bearing.azimuth_rad), level * std::cos(bearing.azimuth_rad),
          std::sin(bearing.elevation_rad)};
}

inline Bearing bearing_of(const Eigen::Vector3d& direction) {
  double azimuth = std::atan2(direction.x(), direction.y());
  if (azimuth < 0.0) azimuth += 2.0 * std::numbers::pi;
  return {azimuth, std::atan2(direction.z(), std::hypot(direction.x(), direction.y()))};
}

// The same distant thing as seen from another place of the body, `east_rad` and `north_rad` away: lengths on
// the map over the body's radius. The level turns with the place, north stays the map's; both must be small
// (their squares are left out, 2e-6 rad at 2.5 km on the Moon).
inline Bearing seen_from(const Bearing& here, double east_rad, double north_rad) {
  const Eigen::Vector3d v = towards(here);
  return bearing_of(
      {v.x() - east_rad * v.z(), v.y() - north_rad * v.z(), v.z() + east_rad * v.x() + north_rad * v.y()});
}

}  // namespace slipway::sky
