#pragma once

#include <cstddef>
#include <span>

#include "sim/wheel/wheel_forces.h"

namespace slipway::sim {

// One wheel, its soil and its motion as plain numbers, field by field as in WheelGeometry, Soil and
// WheelMotion.
struct WheelNumbers {
  double radius, width, rim_friction, grouser_height, grouser_count, per_cleat_shear, cleat_by_slip;
  double stiffness, n, cohesion, phi, per_shear_x, per_shear_y;  // k_c / b + k_phi; 1 / K
  double c1, c2, n1, n1_skid, n1_lateral, exit_ratio, coupling;
  double unit_weight, bulldozing, side_bulldozing;
  double crust_strength, per_crust_depth, hardpan_modulus, hardpan_depth;
  double theta_f, forward, leftward;
};

WheelNumbers numbers_of(const WheelGeometry& wheel, const Soil& soil, double entry_angle_rad,
                        const WheelMotion& motion);

// Which parts of the law are at work in any of the wheels: the others are left out.
struct LawParts {
  bool lateral = false, independent = false, coupled = false, grousers = false, bulldozing = false,
       side_bulldozing = false, crust = false, hardpan = false;

  void include(const WheelNumbers& in);
};

// The law compiled for one instruction set.
struct WheelKernel {
  const char* instruction_set;
  std::size_t lanes;  // wheels that `many` computes at a time
  void (*one)(const WheelNumbers& in, const LawParts& parts, WheelForces& out);
  void (*many)(const WheelNumbers* in, const LawParts& parts, WheelForces* out, std::size_t count);
};

// The fastest kernel that this machine runs. Kernels agree to rounding (tests), not to the bit: the same
// request gives the same bytes on the same kind of machine.
const WheelKernel& wheel_kernel();
// Forces of several wheels, each on its own soil: spans of one length. Takes them in packs and, where less
// than half a pack is left over, one by one.
void wheel_forces(std::span<const WheelNumbers> wheels, std::span<WheelForces> forces);
// All kernels this machine runs, slowest first.
int wheel_kernels(const WheelKernel** out, int capacity);

}  // namespace slipway::sim
