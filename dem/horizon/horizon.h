#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "dem/terrain.h"

namespace slipway::dem {

// What is seen from a place: the elevation of the ground's horizon in any direction. The ground is the
// terrain's bilinear surface; cells without data hide nothing. On a body the ground falls away by d^2 / (2 R)
// with the distance d. Thread-safe.
class Horizon {
 public:
  // `around`: a coarser terrain in the same map frame, which is met where a ray has left the first one.
  // `body_radius_m`: of a local frame, which lies on no body, infinite.
  Horizon(std::shared_ptr<const Terrain> terrain, double body_radius_m,
          std::shared_ptr<const Terrain> around = nullptr);
  ~Horizon();
  Horizon(Horizon&&) noexcept;

  // The elevation [rad] over the level, in a direction clockwise from north, as seen from `eye_m` over the
  // ground at (x, y); -pi/2 where no ground lies that way. Empty where the place has no height.
  std::optional<double> elevation_rad(double x_m, double y_m, double eye_m, double azimuth_rad) const;
  // The same in `count` directions at equal distances, clockwise; the first to the north, or clockwise of it.
  std::optional<std::vector<double>> all_around_rad(double x_m, double y_m, double eye_m, int count,
                                                    double first_rad = 0.0) const;

  double body_radius_m() const { return body_radius_m_; }

 private:
  class Field;
  std::unique_ptr<Field> near_, around_;
  double body_radius_m_ = 0.0;
};

// Between the two nearest of the elevations in equally many directions.
double horizon_between_rad(const std::vector<double>& all_around_rad, double azimuth_rad);

}  // namespace slipway::dem
