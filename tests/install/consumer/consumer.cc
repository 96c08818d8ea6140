// What a wheel on level soil pulls at a slip of 0.3, by the installed headers and library.
#include <iostream>

#include "sim/soil/soil.h"
#include "sim/wheel/wheel_forces.h"

int main() {
  using namespace slipway::sim;
  Soil soil;
  soil.pressure = {.k_c = 1.4e3, .k_phi = 8.2e5, .n = 1.0};
  soil.cohesion_pa = 1000.0;
  soil.friction_angle_rad = 0.6;
  const WheelForces forces = wheel_forces({.radius_m = 0.1, .width_m = 0.06}, soil, 0.6, {.forward = 0.7});
  std::cout << "pull " << forces.drawbar_pull_n << " N, load " << forces.vertical_n << " N\n";
  return forces.vertical_n > 0.0 ? 0 : 1;
}
