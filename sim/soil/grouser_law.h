#pragma once

#include <algorithm>
#include <cmath>

#include "sim/soil/bulldozing_law.h"

namespace slipway::sim {

// Thrust of one grouser: the passive earth pressure on its face [ARTEMIS eq. 15]
//
//   F_g = b (gamma h^2 N_phi / 2 + 2 c h sqrt(N_phi)) cos(alpha),    N_phi = tan^2(pi/4 + phi/2)
//
//   b  width, m    h  height, m    gamma  unit weight, N/m^3    c  cohesion, Pa    phi  friction angle
//
// with alpha = 0 (grousers straight across). It acts on the grouser at 2/3 of its height, F_g cos(theta)
// along the travel and F_g sin(theta) upward [ARTEMIS eq. 18, 20]. The count in contact is taken as its mean
// over a turn, count (theta_f - theta_r) / (2 pi), and each grouser's share of F_g as the share of the shear
// strength mobilised where it stands: the paper's full F_g would push a wheel that rolls freely. A wedge of
// soil before a cleat may yield at less displacement than the soil under the rim (Grousers::mobilisation),
// and that displacement may be of slip alone (Grousers::by_slip): closures, of which the paper says nothing.
template <class V>
V grouser_force_n(const V& width_m, const V& height_m, const V& unit_weight_n_m3, const V& cohesion_pa,
                  const V& tan_phi) {
  return passive_pressure_n(width_m, height_m, unit_weight_n_m3, cohesion_pa, tan_phi);
}

// The pressure q of the rim beside a cleat presses on the wedge that the cleat pushes: passive pressure has a
// third term [Terzaghi 1943; Wong 2010],
//
//   F_g = b (gamma h^2 N_phi / 2 + q h N_phi + 2 c h sqrt(N_phi)),
//
// with q = surcharge sigma here, since some of the rim's pressure is borne by the wedge under the rim: 1 is
// the textbook's. Per Pa of q, over the two terms without it: N_phi / (gamma h N_phi / 2 + 2 c sqrt(N_phi)).
// Property: falls with cohesion and with height; a cleat in soil that bears nothing by itself has none.
template <class V>
V grouser_surcharge_per_pa(const V& height_m, const V& unit_weight_n_m3, const V& cohesion_pa,
                           const V& tan_phi) {
  using std::max, std::sqrt;
  const V root = tan_phi + sqrt(V(1.0) + tan_phi * tan_phi);
  const V by_itself = passive_pressure_n(V(1.0), height_m, unit_weight_n_m3, cohesion_pa, tan_phi);
  return height_m * root * root / max(by_itself, V(1e-9));
}

// The arm of a grouser's thrust about the axle.
template <class V>
V grouser_arm_m(const V& radius_m, const V& height_m) {
  return radius_m + V(2.0 / 3.0) * height_m;
}

// Where the soil is sheared between cleats: at r + lambda h. Soil between tall, close cleats turns with the
// wheel, so that it is sheared near the tips [Ding et al. 2011, who take such an equivalent radius for forces
// and for slip]. The share lambda from height and spacing: before a cleat that is pushed stands Rankine's
// passive wedge, as long as h tan(pi/4 + phi/2); what it covers of the way to the next cleat's tip turns with
// the wheel:
//
//   lambda = min(1, h tan(pi/4 + phi/2) / (2 pi (r + h) / count))
//
// 24 cleats of 5 mm on a rim of 58 mm have 0.5 (fitted there: between 0 and 1 the forces hardly differ), 30
// of 10 mm on a rim of 157 mm 0.5 (Ding's choice). Properties: 0 without cleats, 1 where the wedges meet;
// rises with height and count.
template <class V>
V shear_share_by_spacing(const V& radius_m, const V& height_m, const V& count, const V& tan_phi) {
  using std::min, std::sqrt;
  const V wedge = height_m * (tan_phi + sqrt(V(1.0) + tan_phi * tan_phi));
  return min(V(1.0), wedge * count / (V(2.0 * M_PI) * (radius_m + height_m)));
}

// That radius, with a share that is given and a factor of the one by spacing.
template <class V>
V shear_radius_m(const V& radius_m, const V& height_m, const V& count, const V& share, const V& by_spacing,
                 const V& tan_phi) {
  using std::min;
  const V spaced = shear_share_by_spacing(radius_m, height_m, count, tan_phi);
  return radius_m + min(V(1.0), share + by_spacing * spaced) * height_m;
}

}  // namespace slipway::sim
