#pragma once

#include <cmath>

namespace slipway::sim {

// A crust on loose soil, as pressure besides the soil's own:
//
//   p = s (z / d) exp(1 - z / d)
//
//   s   strength: the greatest pressure the crust adds, Pa        d   depth at which it breaks, m
//   z   depth of the rim, m, >= 0
//
// It carries up to s at z = d, breaks, and what is left decays: a wheel that breaks through stands on the
// soil below. The hump is Wong's for muskeg mats with a surface layer [Wong 2010, section 2.4] in the smooth
// form used for shear curves with a hump [Kacigin & Guskov 1968]. Where s is large the load over the sinkage
// has a hump too, and a wheel may stand on the crust or below it under the same load. Properties: 0 at z = 0,
// s at z = d, falling beyond, 0 for s = 0.
template <class V>
V duricrust_pressure_pa(const V& strength_pa, const V& depth_over_break) {
  using std::exp;
  return strength_pa * depth_over_break * exp(V(1.0) - depth_over_break);
}

}  // namespace slipway::sim
