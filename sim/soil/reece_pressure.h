#pragma once

#include "sim/soil/soil_law.h"

namespace slipway::sim {

// Pressure and sinkage after Reece [Reece 1965; Wong 2010, section 2.4]:
//
//   p = (c k_c' + gamma b k_phi') (z / b)^n
//
//   p      pressure, Pa                  b       smaller side of the contact, m
//   z      depth, m, >= 0                n       exponent of sinkage
//   c      cohesion, Pa                  gamma   unit weight, density times the place's gravity, N/m^3
//   k_c'   cohesive modulus, 1           k_phi'  frictional modulus, 1
//
// The moduli have no units, so that tests with plates of different width, and under different gravity, belong
// to one pair of them: a soil without cohesion carries in proportion to gravity and width. Valid like
// Bekker's law for slow loading of homogeneous ground by a plate not much smaller than those that gave the
// moduli. Slip sinkage raises n in the law as it stands, so that z / b counts, not z.
//
// Properties: p(0) = 0; doubling the depth raises p by 2^n; in soil without cohesion doubling gravity doubles
// p; in soil without weight p depends on z / b alone; for one width it is Bekker's law with k_c / b + k_phi =
// (c k_c' + gamma b k_phi') / b^n.
struct ReeceModuli {
  double k_c = 0.0;    // k_c'
  double k_phi = 0.0;  // k_phi'
};

// p at z = b.
inline double reece_stiffness_pa(const ReeceModuli& moduli, double cohesion_pa, double unit_weight_n_m3,
                                 double width_m) {
  return cohesion_pa * moduli.k_c + unit_weight_n_m3 * width_m * moduli.k_phi;
}

extern const PressureSinkageLaw kReecePressure;

}  // namespace slipway::sim
