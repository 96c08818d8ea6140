#pragma once

#include "sim/soil/soil_law.h"

namespace slipway::sim {

// Mobilised shear strength by a hyperbola [Kondner 1963; Duncan & Chang 1970]:
//
//   tau / tau_max = j / (K + j),    tau_max = c + sigma tan(phi)
//
//   j   shear displacement, m, >= 0      K   displacement at which half of the strength is mobilised, m
//
// It rises as Janosi and Hanamoto's law of the same K does at first, and reaches its end far later: 50 % at
// K, 80 % at 4 K, 90 % at 9 K. Dry sand under a wheel does so: much of the pull is there at slip 0.1 and then
// rises slowly, which one exponential cannot do (docs/method/wheel.md has the comparison on held-out slips).
// K of a hyperbola is about half of K of an exponential that is fitted to the same tests.
// Properties: 0 at j = 0, slope 1 there in j / K, below 1.
template <class V>
V hyperbolic_mobilised(const V& displacement_over_modulus) {
  return displacement_over_modulus / (V(1.0) + displacement_over_modulus);
}

extern const ShearLaw kHyperbolicShear;

}  // namespace slipway::sim
