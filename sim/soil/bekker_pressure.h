#pragma once

#include <cmath>

namespace slipway::sim {

// Pressure and sinkage [Bekker 1956], [ARTEMIS eq. 1], [Zhurong eq. A10]:
//
//   p = (k_c / b + k_phi) z^n
//
//   p      pressure, Pa               b   smaller side of the contact, m
//   z      depth, m, >= 0             k_c, k_phi, n   moduli of sinkage (see BekkerModuli)
//
// Takes the stiffness k_c / b + k_phi. V is a number or a pack of them. Valid for slow loading of homogeneous
// ground by a plate not much smaller than those that gave the moduli. Properties: p(0) = 0; doubling the
// depth raises p by 2^n.
template <class V>
V bekker_pressure_pa(const V& stiffness, const V& n, const V& depth_m) {
  using std::exp, std::log;
  return stiffness * exp(n * log(depth_m));
}

}  // namespace slipway::sim
