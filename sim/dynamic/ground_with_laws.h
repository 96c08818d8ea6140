#pragma once

#include <fmt/format.h>

#include <Eigen/Core>
#include <optional>
#include <string>

#include "sim/dynamic/drive_soils.h"
#include "sim/rover/ground.h"

namespace slipway::sim {

// Ground that is known by a slip curve alone: there are no forces to simulate a drive with.
inline bool on_slip_curve(const Ground& ground, const DriveSoils& soils, double x_m, double y_m) {
  return soils.of(ground.soil_at(x_m, y_m)).slip_curve != nullptr;
}

inline std::string slip_curve_reason(const Eigen::Vector2d& place) {
  return fmt::format(
      "the dynamic level needs a soil with laws of its forces; the ground at ({:.2f}, {:.2f}) m is known by "
      "a slip curve alone",
      place.x(), place.y());
}

// The ground without what is known by a slip curve alone.
class GroundWithLaws : public Ground {
 public:
  GroundWithLaws(const Ground& ground, const DriveSoils& soils) : ground_(ground), soils_(soils) {}
  std::optional<GroundPoint> at(double x_m, double y_m) const override {
    if (on_slip_curve(ground_, soils_, x_m, y_m)) return std::nullopt;
    return ground_.at(x_m, y_m);
  }
  std::optional<std::size_t> soil_at(double x_m, double y_m) const override {
    return ground_.soil_at(x_m, y_m);
  }

 private:
  const Ground& ground_;
  const DriveSoils& soils_;
};

}  // namespace slipway::sim
