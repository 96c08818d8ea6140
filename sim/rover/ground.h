#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>

namespace slipway::sim {

struct GroundPoint {
  double height_m = 0.0;
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  // unit, upward, frame M
};

// The ground as the rover meets it. sim has never seen a raster: whoever owns one implements this.
class Ground {
 public:
  virtual ~Ground() = default;
  // Nothing off the map and where there is no elevation.
  virtual std::optional<GroundPoint> at(double x_m, double y_m) const = 0;
  // Index into the list of soil beliefs that goes with this ground; nothing on unknown ground.
  virtual std::optional<std::size_t> soil_at(double x_m, double y_m) const = 0;
};

}  // namespace slipway::sim
