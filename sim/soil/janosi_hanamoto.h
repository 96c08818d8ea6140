#pragma once

#include <cmath>

namespace slipway::sim {

// Mobilised shear strength [Janosi & Hanamoto 1961], [ARTEMIS eq. 3 and 6], [Zhurong eq. A4]:
//
//   tau / tau_max = 1 - exp(-j / K),    tau_max = c + sigma tan(phi)
//
//   j      shear displacement, m, >= 0        K   shear modulus, m
//
// Takes j / K. V is a number or a pack of them. Valid for loose sand and disturbed soil, whose shear stress
// has no hump. Properties: 0 at j = 0, slope 1 there, below 1.
template <class V>
V janosi_hanamoto_mobilised(const V& displacement_over_modulus) {
  using std::exp;
  return V(1.0) - exp(-displacement_over_modulus);
}

}  // namespace slipway::sim
