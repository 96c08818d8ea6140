#pragma once

#include <cmath>

namespace slipway::sim {

// Depth of the soil that a slipping rim and its cleats carry out from under a wheel, besides the depth at
// which the soil bears it:
//
//   z_d = (d r n / (n + s |u|) + k h n / (|u| + n / m)) (1 + q / (1 + (cos(beta) / 0.1)^2))
//
//   n = max(0, 1 - u_x)    speed of the rim over the soil, over the rim's; n / |u| is the slip travel: i / (1
//   - i) of a wheel that goes straight at slip i                 u   the wheel's velocity over the rim's
//   speed r, h   radius of the rim, height of its cleats, m          d, s   the rim's: greatest depth over
//   the radius, slip travel at which half of it is dug             k, m   the cleats': depth per slip travel
//   over their height, slip travel that they do not dig beyond      q   what moving straight sideways adds
//
// k h i / (1 - i) is Reece's slip sinkage of grousers: each carries out the soil between two of them [Reece
// 1965]; falling back ends it at fast slip. The wheel stands in the pit that it has dug: its contact is that
// of a wheel on level ground at the pit's depth, so that digging lengthens no contact and raises no pull.
//
// To carry that soil out costs the passive pressure of so much loose soil before the front
// (bulldozing_law.h), which is the work to lift it and to break it up on every metre, and its friction along
// the rim:
//
//   P_d = gamma b z_d^2 N_phi / 2, taken from the pull where the wheel moves (front_share);  T_d = mu r P_d
//
//   gamma  unit weight, N/m^3    b  width, m    mu  rim's share of tan(phi)
//
// Cohesion is not in it: what the rim breaks it breaks by the shear stress that the contact has already.
// Properties of z_d: 0 without slip and in skid; rises with slip and with the cleats' height; bounded by d r
// + k h m times the last factor. P_d and T_d rise with its square.
template <class V>
V dug_depth_m(const V& rim_dug_m, const V& rim_slip, const V& cleat_dug_m, const V& per_cleat_limit,
              const V& sideways, const V& forward, const V& speed) {
  using std::max;
  constexpr double kAcross = 0.1;
  const V n = max(V(0.0), V(1.0) - forward);
  const V tiny = V(1e-9);
  const V depth =
      rim_dug_m * n / (n + rim_slip * speed + tiny) + cleat_dug_m * n / (speed + n * per_cleat_limit + tiny);
  const V ratio = forward / (V(kAcross) * speed + tiny);
  return depth * (V(1.0) + sideways / (V(1.0) + ratio * ratio));
}

}  // namespace slipway::sim
