#pragma once

#include <algorithm>

namespace slipway::sim {

// A stiff layer at depth under loose soil, as pressure besides the soil's own:
//
//   p = k max(0, z - d)
//
//   k   modulus of the layer, Pa/m        d   its depth, m        z   depth of the rim, m
//
// The layer's own sinkage is that of an elastic foundation (Winkler), which rock and frozen ground under sand
// come near. Properties: 0 above the layer, slope k below, 0 for k = 0.
template <class V>
V hardpan_pressure_pa(const V& modulus_pa_m, const V& layer_depth_m, const V& depth_m) {
  using std::max;
  return modulus_pa_m * max(V(0.0), depth_m - layer_depth_m);
}

}  // namespace slipway::sim
