#pragma once

#include <cmath>

namespace slipway::sim {

// Soil that a wheel pushes before its front and its wall, in the form of passive earth pressure:
//
//   P_front = H N_f gamma / 2 b (z - z_d)^2      against the motion along the wheel's plane (front_share)
//   P_wall  = H N_w gamma / 2 int f^2 dx         sin(beta), against the motion across it
//   H = 1 + H_0 exp(-rho / q)                    rho = r w / |v|
//
//   gamma  unit weight, N/m^3    b  width, m    z  depth, m    z_d  depth dug by slip (digging_law.h)
//   f(x)   depth of the wall under the surface, over its buried part [ARTEMIS eq. 14]; the formula holds
//   for walls deeper than the axle too
//
// N_f and N_w are factors of passive earth pressure with the spreading of the wedge to the sides in them:
// 3-dimensional wedges before narrow blades have several times Rankine's N_phi [McKyes & Ali 1977]. H is the
// surcharge of the heap that builds up before a wheel which does not turn, and which a turning rim carries
// away. Soil on the wall rubs against it:
//
//   F_x = mu P_wall sin(beta) e / sqrt(e^2 + (y u_y)^2),    e = kappa - u_x
//
//   mu  friction of soil on the wall    kappa  speed along its plane of the wall, which carries soil along,
//   over the rim's    y  how far soil that yields sideways turns the friction away from the wall's plane
//
// Found on the smooth wheel of [Pavlov & Johnson 2022] and half of the grousered wheel's tests, where N_f is
// 8.5, N_w 12, H_0 1.7. Properties: 0 at the surface; all rise with depth squared or faster; H falls from 1 +
// H_0 to 1 with rho.
template <class V>
V heap_factor(const V& heap, const V& per_heap_slip, const V& speed) {
  using std::exp, std::max;
  return V(1.0) + heap * exp(-per_heap_slip / max(speed, V(1e-3)));
}

// The integral of f^2 over the wall's buried part, m^3: r the radius, theta_f the angle at which the rim
// meets the surface, in [0, pi).
template <class V>
V wall_depth_square_m3(const V& radius_m, const V& theta_f, const V& sin_f, const V& cos_f) {
  const V s = sin_f, c = cos_f, angle = theta_f + s * c;
  return radius_m * radius_m * radius_m *
         (V(2.0) * s - V(2.0 / 3.0) * s * s * s - V(2.0) * c * angle + V(2.0) * c * c * s);
}

// Share of the wall's friction that acts along the wheel's plane, with its sign: positive drives.
template <class V>
V wall_friction_share(const V& wall_turn, const V& wall_yield, const V& forward, const V& leftward) {
  using std::sqrt;
  const V along = wall_turn - forward, across = wall_yield * leftward;
  return along / sqrt(along * along + across * across + V(1e-6));
}

}  // namespace slipway::sim
