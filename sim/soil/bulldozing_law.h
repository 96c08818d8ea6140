#pragma once

#include <cmath>

namespace slipway::sim {

// Passive earth pressure on a vertical face of width b that is pushed into soil from the surface to depth z
// [Rankine; Terzaghi 1943]:
//
//   P = b (gamma z^2 N_phi / 2 + 2 c z sqrt(N_phi)),    N_phi = tan^2(pi/4 + phi/2)
//
//   gamma  unit weight, N/m^3    c  cohesion, Pa    phi  friction angle
//
// sqrt(N_phi) = tan(pi/4 + phi/2) = tan(phi) + sqrt(1 + tan^2(phi)). At the front of a sunk wheel it is the
// resistance of the soil heaped before it, an upper bound: a round rim also rides over what it pushes.
// Properties: 0 at z = 0; quadruples with doubled depth in dry soil; rises with phi and c.
template <class V>
V passive_pressure_n(const V& width_m, const V& depth_m, const V& unit_weight_n_m3, const V& cohesion_pa,
                     const V& tan_phi) {
  using std::sqrt;
  const V root = tan_phi + sqrt(V(1.0) + tan_phi * tan_phi);
  return width_m * depth_m * root * (V(0.5) * unit_weight_n_m3 * depth_m * root + V(2.0) * cohesion_pa);
}

// The share of it that pushes back at a wheel's front when it moves at an angle: passive pressure is
// mobilised by any motion into the soil, so that it falls off near sideways motion only (as the locked wheel
// of [Pavlov & Johnson 2022] shows: 0.96 at 45 deg, 0.58 at 75 deg):
//
//   x / sqrt(x^2 + e^2) sqrt(1 + e^2),    x = cos(beta), e = 0.3
template <class V>
V front_share(const V& cos_beta) {
  using std::sqrt;
  constexpr double kSideways = 0.3, kAhead = 1.0440306508910550;  // sqrt(1 + e^2)
  return V(kAhead) * cos_beta / sqrt(cos_beta * cos_beta + V(kSideways * kSideways));
}

}  // namespace slipway::sim
