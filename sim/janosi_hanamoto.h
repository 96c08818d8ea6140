#pragma once

#include "sim/soil_law_catalogue.h"

namespace slipway::sim {

// Mobilised shear strength [Janosi & Hanamoto 1961], [ARTEMIS eq. 3 and 6], [Zhurong eq. A4]:
//
//   tau / tau_max = 1 - exp(-j / K),    tau_max = c + sigma tan(phi)
//
//   j      shear displacement, m, >= 0        K   shear modulus, m
//
// Valid for loose sand and disturbed soil, whose shear stress has no hump. Properties: 0 at j = 0, slope 1 /
// K there, below 1.
inline ArcValues janosi_hanamoto_mobilised(const ArcValues& displacement_m, double shear_modulus_m) {
  return 1.0 - (displacement_m * (-1.0 / shear_modulus_m)).exp();
}

}  // namespace slipway::sim
