#pragma once

#include "sim/soil/soil_law.h"

namespace slipway::sim {

// Mobilised shear strength of soil whose shear stress has a hump and falls to a residual [Wong &
// Preston-Thomas 1983; Wong 2010, section 2.4]:
//
//   tau / tau_max = K_r (1 + (1 / (K_r (1 - 1/e)) - 1) e^(1 - j / K_w)) (1 - e^(-j / K_w))
//
//   j    shear displacement, m, >= 0     K_w   displacement at which the stress is greatest, m: Soil's shear
//   modulus K_r  residual over greatest stress, [0.3, 0.9]
//
// Valid for firm, undisturbed soil, whose structure the shearing breaks: compact sand, loam, snow with a
// crust. In the kernel's form its end is K_r and its hump e (1 / (1 - 1/e) - K_r).
//
// Properties: 0 at j = 0; 1 at j = K_w; falls towards K_r beyond. Its greatest value lies near K_w and not
// quite at it: for K_r in [0.3, 0.9], the range that is taken, it is at most 1.03, at 0.78 to 1.36 K_w.
ShearForm wong_shear_form(double residual_ratio);

extern const ShearLaw kWongShear;

}  // namespace slipway::sim
