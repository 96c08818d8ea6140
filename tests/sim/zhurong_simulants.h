#pragma once

#include <array>

#include "sim/single_wheel/sweep_parameter.h"
#include "tests/sim/reference_models.h"

namespace slipway::sim {

// Zhurong Table 1 with c1 and c2 of Table A1: [simulant 1 to 3][loose, medium, dense].
inline std::array<std::array<Soil, 3>, 3> jlu_mars() {
  const auto soil = [](double k_c_kn, double k_phi_kn, double n, double c_kpa, double phi, double k_cm,
                       double c1) {
    return make_soil({1e3 * k_c_kn, 1e3 * k_phi_kn, n}, 1e3 * c_kpa, phi, 0.01 * k_cm, c1, 0.32);
  };
  return {{{soil(5.471, 234.221, 0.910, 0.383, 19.1, 1.33, 0.285),
            soil(58.375, 10276.77, 1.067, 0.541, 30.6, 1.38, 0.18),
            soil(740.32, 11155.956, 1.172, 1.131, 37.8, 1.62, 0.43)},
           {soil(20.538, 328.221, 0.956, 0.354, 35.1, 1.51, 0.285),
            soil(10.843, 1638.496, 0.993, 0.672, 37.1, 1.71, 0.18),
            soil(314.413, 7432.759, 1.12, 0.801, 39.3, 1.92, 0.43)},
           {soil(3.125, 536.156, 0.867, 0.102, 33.2, 1.71, 0.285),
            soil(47.578, 2225.388, 1.022, 0.168, 36.8, 1.83, 0.18),
            soil(552.963, 6879.961, 1.107, 0.437, 37.6, 2.07, 0.43)}}};
}

// A wheel of Zhurong's test vehicle on a simulant, on Earth.
inline WheelRig zhurong_rig(const Soil& soil) {
  WheelRig rig;
  WheelModel wheel;
  wheel.radius_m = 0.1475;
  wheel.width_m = 0.2;
  rig.rover.wheels = {wheel};
  rig.rover.drive.torque_constant_nm_per_a = 0.1578;
  rig.rover.drive.gear_ratio = 79.3;
  rig.rover.drive.gear_efficiency = 1.0;
  rig.rover.drive.no_load_current_a = 0.0;
  rig.soil = soil;
  rig.test.load_n = 34.08 * 9.81;
  rig.test.gravity_m_s2 = 9.81;
  return rig;
}

}  // namespace slipway::sim
