#pragma once

#include <cmath>

namespace slipway::sim {

// Terzaghi's factors of bearing capacity [Terzaghi, Peck & Mesri 1996; ARTEMIS eq. 13]:
//
//   N_q = exp((3 pi/2 - phi) tan phi) / (2 cos^2(pi/4 + phi/2))
//   N_c = (N_q - 1) / tan phi,      5.71 as phi -> 0
//   N_gamma = 2 (N_q + 1) tan phi / (1 + 0.4 sin 4 phi)
template <class V>
struct TerzaghiFactors {
  V n_q, n_c, n_gamma;
};

template <class V>
TerzaghiFactors<V> terzaghi_factors(const V& phi, const V& tan_phi) {
  using std::exp, std::cos, std::sin, std::max;
  const V half = cos(V(M_PI / 4) + V(0.5) * phi);
  const V n_q = exp((V(1.5 * M_PI) - phi) * tan_phi) / (V(2.0) * half * half);
  // Below a microradian the quotient is its limit to better than the rounding of N_q - 1.
  const V n_c = (n_q - V(1.0) + V(5.71e-6)) / (max(tan_phi, V(0.0)) + V(1e-6));
  return {n_q, n_c, V(2.0) * (n_q + V(1.0)) * tan_phi / (V(1.0) + V(0.4) * sin(V(4.0) * phi))};
}

// Soil pushed aside by a wheel's side wall [ARTEMIS eq. 12 and 14, without surcharge]:
//
//   F_b = int_{-s}^{s} (gamma N_gamma f + c N_c) f dx,    f(x) = sqrt(r^2 - x^2) - h
//
//   s = r sin(theta_f)  half the chord at the surface     h = r cos(theta_f) = r - z  the axle over the
//   surface
//
// (the depth of the wall under the surface; the paper's "- z_0" stands for -(r - z)). In closed form:
//
//   int f dx   = r^2 (theta_f - sin cos)
//   int f^2 dx = 2 r^2 s - 2/3 s^3 - 2 h r^2 (theta_f + sin cos) + 2 h^2 s
template <class V>
V side_wall_force_n(const V& radius_m, const V& theta_f, const V& sin_f, const V& cos_f,
                    const V& unit_weight_n_m3, const V& cohesion_pa, const V& phi, const V& tan_phi) {
  const V r2 = radius_m * radius_m, s = radius_m * sin_f, h = radius_m * cos_f, product = sin_f * cos_f;
  const V area = r2 * (theta_f - product);
  const V square =
      V(2.0) * r2 * s - V(2.0 / 3.0) * s * s * s - V(2.0) * h * r2 * (theta_f + product) + V(2.0) * h * h * s;
  const TerzaghiFactors<V> factors = terzaghi_factors(phi, tan_phi);
  return unit_weight_n_m3 * factors.n_gamma * square + cohesion_pa * factors.n_c * area;
}

// The side wall's resistance is F_b sin(beta) at a slip angle beta [ARTEMIS eq. 19]; others let all of the
// passive pressure act as soon as the wheel slides sideways [Ishigami et al. 2007]. Between the two lies
//
//   F_b sin(beta) / sqrt(sin(a)^2 + cos(a)^2 sin(beta)^2)
//
// with the slip angle a at which most of F_b acts: ARTEMIS's at 90 deg, close to the others' at a few
// degrees. This is the second factor, by forward and sideways speeds of any unit; 1 where the wheel stands.
template <class V>
V early_mobilisation(const V& forward, const V& leftward, const V& squared_sin_a) {
  using std::sqrt;
  const V sideways = leftward * leftward, all = forward * forward + sideways, standing = V(1e-12);
  return sqrt((all + standing) / (squared_sin_a * all + (V(1.0) - squared_sin_a) * sideways + standing));
}

}  // namespace slipway::sim
