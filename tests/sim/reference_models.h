#pragma once

#include <cmath>
#include <functional>
#include <string>
#include <utility>

#include "core/angle.h"
#include "sim/rover/ground.h"
#include "sim/rover/rover_model.h"
#include "sim/soil/soil.h"
#include "sim/wheel/wheel_forces.h"

namespace slipway::sim {

inline Soil make_soil(BekkerModuli moduli, double cohesion_pa, double friction_deg, double shear_modulus_m,
                      double c1, double c2) {
  Soil soil;
  soil.pressure = moduli;
  soil.cohesion_pa = cohesion_pa;
  soil.friction_angle_rad = rad_from_deg(friction_deg);
  soil.shear_modulus_x_m = soil.shear_modulus_y_m = shear_modulus_m;
  soil.c1 = c1;
  soil.c2 = c2;
  return soil;
}

inline Soil ding_like() {
  return make_soil({15600.0, 2407400.0, 1.1}, 250.0, 31.9, 0.011, 0.18, 0.32);
}

inline Soil sandy_loam() {
  return make_soil({20000.0, 1.2e6, 0.95}, 1500.0, 36.0, 0.01, 0.18, 0.32);
}
inline Soil loose_sand() {
  return make_soil({3125.0, 536156.0, 0.867}, 102.0, 33.2, 0.0171, 0.285, 0.32);
}

inline SoilDistribution certain(const char* name, const Soil& soil) {
  SoilDistribution belief;
  belief.name = name;
  belief.mean = soil;
  return belief;
}

inline SoilDistribution spread(const char* name, const Soil& soil, double relative) {
  SoilDistribution belief = certain(name, soil);
  belief.std = {relative, 0.1 * relative, relative * soil.cohesion_pa,
                relative * 0.3 * soil.friction_angle_rad, relative};
  return belief;
}

// A six-wheeler of MER's size, written out so that these tests need no file.
inline RoverModel six_wheeler() {
  RoverModel rover;
  rover.name = "six-wheeler";
  rover.mass_kg = 174.0;
  rover.com_m = {-0.03, 0.0, 0.38};
  const char* names[] = {"lf", "lm", "lr", "rf", "rm", "rr"};
  const double x[] = {0.7, 0.0, -0.7}, y[] = {0.53, 0.61, 0.53};
  for (int k = 0; k < 6; ++k) {
    WheelModel wheel;
    wheel.name = names[k];
    wheel.side = k < 3 ? Side::kLeft : Side::kRight;
    wheel.position_m = {x[k % 3], k < 3 ? y[k % 3] : -y[k % 3], 0.125};
    wheel.steerable = k % 3 != 1;
    wheel.on_bogie = k % 3 != 0;
    rover.wheels.push_back(wheel);
  }
  rover.suspension = {SuspensionType::kRockerBogie, {0.12, 0.45, 0.42}, {-0.35, 0.55, 0.3}};
  rover.drive.max_wheel_rate_rad_s = rad_from_deg(25.0);
  return rover;
}

// `columns` wheels a side from front to rear, evenly spaced, none steered.
inline RoverModel even_wheeler(SuspensionType suspension, int columns) {
  RoverModel rover = six_wheeler();
  rover.name = "even-wheeler";
  rover.mass_kg = 29.0 * 2 * columns;
  rover.com_m = {0.0, 0.0, 0.35};
  rover.wheels.clear();
  for (int k = 0; k < 2 * columns; ++k) {
    WheelModel wheel;
    wheel.side = k < columns ? Side::kLeft : Side::kRight;
    const int place = k % columns;
    wheel.name = (k < columns ? "l" : "r") + std::to_string(place + 1);
    wheel.position_m = {0.7 - 1.4 * place / (columns - 1), k < columns ? 0.5 : -0.5, 0.125};
    rover.wheels.push_back(wheel);
  }
  if (columns == 2) {
    const char* names[] = {"lf", "lr", "rf", "rr"};
    for (int k = 0; k < 4; ++k) rover.wheels[k].name = names[k];
  }
  rover.suspension = {.type = suspension, .rocker_pivot_m = {0.0, 0.4, 0.4}};
  return rover;
}

// In the order lf lr rf rr.
inline RoverModel four_wheeler(SuspensionType suspension) {
  return even_wheeler(suspension, 2);
}

// Two wheels in front, one behind.
inline RoverModel three_wheeler() {
  RoverModel rover = four_wheeler(SuspensionType::kRigid);
  rover.name = "three-wheeler";
  rover.mass_kg = 87.0;
  rover.com_m.x() = 0.2;
  rover.wheels = {rover.wheels[0], rover.wheels[2], rover.wheels[1]};
  rover.wheels[2].name = "tail";
  rover.wheels[2].position_m.y() = 0.0;
  return rover;
}

inline RoverModel all_steered(RoverModel rover) {
  for (WheelModel& wheel : rover.wheels) wheel.steerable = true;
  return rover;
}

// Ground in closed form: the height is a function of the place, and normals are by central differences. The
// soil is unknown where the second function says so.
class FunctionGround final : public Ground {
 public:
  using Height = std::function<double(double, double)>;
  using SoilIndex = std::function<std::optional<std::size_t>(double, double)>;

  explicit FunctionGround(
      Height height, double reach_m = 1e6,
      SoilIndex soil = [](double, double) { return std::optional<std::size_t>(0); })
      : height_(std::move(height)), soil_(std::move(soil)), reach_m_(reach_m) {}

  std::optional<GroundPoint> at(double x, double y) const override {
    if (std::abs(x) > reach_m_ || std::abs(y) > reach_m_) return std::nullopt;
    constexpr double h = 1e-5;
    const Eigen::Vector3d slope((height_(x - h, y) - height_(x + h, y)) / (2 * h),
                                (height_(x, y - h) - height_(x, y + h)) / (2 * h), 1.0);
    return GroundPoint{height_(x, y), slope.normalized()};
  }
  std::optional<std::size_t> soil_at(double x, double y) const override { return soil_(x, y); }

 private:
  Height height_;
  SoilIndex soil_;
  double reach_m_;
};

}  // namespace slipway::sim
