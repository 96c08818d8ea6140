#pragma once

#include "sim/soil_law_catalogue.h"

namespace slipway::sim {

// Pressure and sinkage [Bekker 1956], [ARTEMIS eq. 1], [Zhurong eq. A10]:
//
//   p = (k_c / b + k_phi) z^n
//
//   p      pressure, Pa               b   smaller side of the contact, m
//   z      depth, m                   k_c, k_phi, n   moduli of sinkage (see BekkerModuli)
//
// Valid for slow loading of homogeneous ground by a plate not much smaller than those that gave the moduli.
// Properties: p(0) = 0; doubling the depth raises p by 2^n.
inline ArcValues bekker_pressure_pa(const BekkerModuli& moduli, double n, double width_m,
                                    const ArcValues& depth_m) {
  return moduli.stiffness(width_m) * (n * depth_m.log()).exp();
}

}  // namespace slipway::sim
