#pragma once

#include <cmath>
#include <xsimd/xsimd.hpp>

#include "sim/soil/bekker_pressure.h"
#include "sim/soil/bulldozing_law.h"
#include "sim/soil/duricrust_law.h"
#include "sim/soil/grouser_law.h"
#include "sim/soil/hardpan_law.h"
#include "sim/soil/janosi_hanamoto.h"
#include "sim/soil/terzaghi.h"
#include "sim/wheel/wheel_kernel.h"

// The wheel's law, written once over packs of doubles: a pack holds quadrature nodes of one wheel, or the
// same node of several wheels (draws of the soil, say). See wheel_forces.h for the equations.
namespace slipway::sim {

// Below this share of the rim's speed a wheel hardly pushes soil before it.
constexpr double kStandingSpeedRatio = 0.05;

// The laws that a soil has when it chooses none: Bekker's pressure, and Janosi and Hanamoto's shear. A policy
// of this shape gives the pressure at a depth and the mobilised share of the strength; chosen_laws.h has the
// other one.
struct DefaultLaws {
  template <class V>
  V pressure_pa(const WheelValues<V>& in, const V& n, const V& depth_m) const {
    return bekker_pressure_pa(in.stiffness, n, depth_m);
  }
  template <class V>
  V mobilised(const V& displacement_over_modulus) const {
    return janosi_hanamoto_mobilised(displacement_over_modulus);
  }
};

template <class V>
struct ContactAngles {
  V theta_m, theta_r, n;
  V sin_f, cos_f;
  V tan_phi;
  V top;  // where the contact ends in front: the entry angle, or where the rim is upright
  // Of the closures (wheel_closures.h); read where LawParts says that any is at work.
  V slip_directed = V(0.0), cleat_braking = V(1.0), cleat_per_pa = V(0.0);
};

template <class V>
V slip_of(const V& speed_ratio) {
  return select(speed_ratio <= V(1.0), V(1.0) - speed_ratio, V(1.0) / max(speed_ratio, V(1.0)) - V(1.0));
}

// `sin_f` and `cos_f` are of the entry angle, `tan_phi` of the friction angle.
template <class V>
ContactAngles<V> contact_angles(const WheelValues<V>& in, const V& sin_f, const V& cos_f, const V& tan_phi) {
  const V slip = min(V(1.0), abs(slip_of(in.forward)));
  const V share = max(-in.exit_ratio, min(V(0.99), in.c1 + in.c2 * slip));
  // How the wheel digs itself in: by its slip over the ground in whatever direction it moves, more in skid
  // and more when it moves sideways.
  const V square = in.forward * in.forward + in.leftward * in.leftward;
  const V sliding = slip_of(sqrt(square));
  const V sin2_beta = in.leftward * in.leftward / (square + V(1e-12));
  const V n = in.n + in.n1 * abs(sliding) + in.n1_skid * max(V(0.0), -sliding) + in.n1_lateral * sin2_beta;
  return {share * in.theta_f, -in.exit_ratio * in.theta_f, n, sin_f, cos_f, tan_phi, in.theta_f};
}

template <class V>
ContactAngles<V> contact_angles(const WheelValues<V>& in) {
  return contact_angles(in, V(sin(in.theta_f)), V(cos(in.theta_f)), V(tan(in.phi)));
}

// Integrals over the contact, per b r: of the shear and normal stress and of the mobilised share m.
template <class V>
struct ContactIntegrals {
  V tau = V(0.0), tau_cos = V(0.0), tau_sin = V(0.0), tau_y = V(0.0), sigma_cos = V(0.0), sigma_sin = V(0.0);
  V m = V(0.0), m_cos = V(0.0), m_sin = V(0.0);
};

// Whether a condition holds in all lanes of a pack.
constexpr bool holds_in_all_lanes(bool condition) {
  return condition;
}
template <class T, class Arch>
bool holds_in_all_lanes(const xsimd::batch_bool<T, Arch>& condition) {
  return xsimd::all(condition);
}

// The mobilised share of the strength, with the sign of the displacement.
template <class Laws, class V>
V mobilised(const Laws& laws, const V& displacement, const V& per_modulus) {
  return copysign(laws.mobilised(abs(displacement) * per_modulus), displacement);
}

// Blends independent mobilisation (left at 0 where the coupling is 1) with one resultant against the
// slipping: j = |(j_x / K_x, j_y / K_y)|, (m_x, m_y) = m(j) (j_x / K_x, j_y / K_y) / j.
template <class Laws, class V>
void couple(const Laws& laws, const WheelValues<V>& in, const V& j_x, const V& j_y, V& m_x, V& m_y) {
  const V a = j_x * in.per_shear_x, b = j_y * in.per_shear_y;
  const V j = sqrt(a * a + b * b) + V(1e-300);
  const V per_j = laws.mobilised(j) / j;
  m_x += in.coupling * (per_j * a - m_x);
  m_y += in.coupling * (per_j * b - m_y);
}

// Where it is at work (Soil::slip_directed), turns the stress against the sliding of the rim over the soil:
// its size is that of the displacements' resultant, its direction that of the sliding velocity
//
//   v_x = r w (1 - u cos(theta)),   v_y
//
// as plastic flow has it [Schwanghart 1968 for wheels that slip and slide sideways]. Soil takes some way to
// turn its stress: within kTurning of the rim's speed the sliding is too slow to direct it.
template <class Laws, class V>
void direct_by_slip(const Laws& laws, const WheelValues<V>& in, const ContactAngles<V>& at, const V& j_x,
                    const V& to_entry, const V& cosine, V& m_x, V& m_y) {
  constexpr double kTurning = 0.1;
  const V a = j_x * in.per_shear_x, b = in.radius * in.leftward * to_entry * in.per_shear_y;
  const V v_x = V(1.0) - in.forward * cosine, v_y = in.leftward;
  const V m = laws.mobilised(sqrt(a * a + b * b)) / sqrt(v_x * v_x + v_y * v_y + V(kTurning * kTurning));
  m_x += at.slip_directed * (m * v_x - m_x);
  m_y += at.slip_directed * (m * v_y - m_y);
}

// sin and cos for |theta| <= pi/2, where a wheel's angles lie: the Taylor series of theta / 2, error below
// 1e-15, and the double angle. Without the reduction of large angles, and without a root, this is a quarter
// of the library's cost.
template <class V>
void rim_sincos(const V& theta, V& sine, V& cosine) {
  const V h = V(0.5) * theta, x = h * h;
  V p = V(1.0 / 355687428096000.0);
  p = fma(p, x, V(-1.0 / 1307674368000.0));
  p = fma(p, x, V(1.0 / 6227020800.0));
  p = fma(p, x, V(-1.0 / 39916800.0));
  p = fma(p, x, V(1.0 / 362880.0));
  p = fma(p, x, V(-1.0 / 5040.0));
  p = fma(p, x, V(1.0 / 120.0));
  p = fma(p, x, V(-1.0 / 6.0));
  const V half_sine = fma(p * x, h, h);
  V q = V(1.0 / 20922789888000.0);
  q = fma(q, x, V(-1.0 / 87178291200.0));
  q = fma(q, x, V(1.0 / 479001600.0));
  q = fma(q, x, V(-1.0 / 3628800.0));
  q = fma(q, x, V(1.0 / 40320.0));
  q = fma(q, x, V(-1.0 / 720.0));
  q = fma(q, x, V(1.0 / 24.0));
  q = fma(q, x, V(-0.5));
  sine = V(2.0) * half_sine * fma(q, x, V(1.0));
  cosine = V(1.0) - V(2.0) * half_sine * half_sine;
}

// Adds nodes of one arc. `weight` holds the quadrature's weights times the arc's length. V is a pack of nodes
// of one wheel, or of one node of several wheels; parameters come in the same type.
template <class Laws, class V>
void add_nodes(const Laws& laws, const WheelValues<V>& in, const ContactAngles<V>& at, const LawParts& parts,
               const V& theta, const V& sine, const V& cosine, const V& sigma, const V& weight,
               ContactIntegrals<V>& sum) {
  const V to_entry = in.theta_f - theta;
  const V j_x = in.radius * (to_entry - in.forward * (at.sin_f - sine));
  V m_x = V(0.0), m_y = V(0.0);
  if (!parts.closures || parts.undirected) {
    if (parts.lateral) {
      const V j_y = in.radius * in.leftward * to_entry;
      if (parts.independent) {
        m_x = mobilised(laws, j_x, in.per_shear_x);
        m_y = mobilised(laws, j_y, in.per_shear_y);
      }
      if (parts.coupled) couple(laws, in, j_x, j_y, m_x, m_y);
    } else {
      m_x = mobilised(laws, j_x, in.per_shear_x);
    }
  }
  if (parts.closures && !holds_in_all_lanes(at.slip_directed == V(0.0)))
    direct_by_slip(laws, in, at, j_x, to_entry, cosine, m_x, m_y);
  const V strength = weight * in.rim_friction * (in.cohesion + sigma * at.tan_phi);
  // No part of the rim is drawn down: soil that would have to hang on to it breaks off.
  const V tau = max(strength * m_x, -weight * sigma * cosine / max(sine, V(1e-9)));
  sum.tau += tau;
  sum.tau_cos += tau * cosine;
  sum.tau_sin += tau * sine;
  sum.sigma_cos += weight * sigma * cosine;
  sum.sigma_sin += weight * sigma * sine;
  if (parts.lateral) sum.tau_y -= strength * m_y;
  if (parts.grousers) {
    // Cleats that mobilise the soil as the rim does need no exponential of their own.
    const auto as_rim = in.per_cleat_shear == in.per_shear_x && in.cleat_by_slip == V(0.0);
    V share = m_x;
    if (!holds_in_all_lanes(as_rim)) {
      const V j_slip = in.radius * to_entry * (V(1.0) - in.forward);
      const V j_cleat = j_x + in.cleat_by_slip * (j_slip - j_x);
      share = select(as_rim, m_x, mobilised(laws, j_cleat, in.per_cleat_shear));
    }
    V m = weight * share;
    if (parts.closures) m = select(m < V(0.0), at.cleat_braking * m, m) * (V(1.0) + at.cleat_per_pa * sigma);
    sum.m += m;
    sum.m_cos += m * cosine;
    sum.m_sin += m * sine;
  }
}

// The pressure under the rim at depth z: the base law and what effects add.
template <class Laws, class V>
V pressure_under_rim(const Laws& laws, const WheelValues<V>& in, const ContactAngles<V>& at,
                     const LawParts& parts, const V& z) {
  V sigma = laws.pressure_pa(in, at.n, z);
  if (parts.crust) sigma += duricrust_pressure_pa(in.crust_strength, z * in.per_crust_depth);
  if (parts.hardpan) sigma += hardpan_pressure_pa(in.hardpan_modulus, in.hardpan_depth, z);
  return sigma;
}

// One pack of nodes t with weights (for an arc of length 1), on both arcs: the rear arc repeats the front
// one's stresses at its own angles, so they are computed once.
template <class Laws, class V>
void add_both_arcs(const Laws& laws, const WheelValues<V>& in, const ContactAngles<V>& at,
                   const LawParts& parts, const V& t, const V& weight, ContactIntegrals<V>& sum) {
  const V front_length = at.top - at.theta_m, rear_length = at.theta_m - at.theta_r;
  const V front = at.top - t * front_length;
  V sine, cosine;
  rim_sincos(front, sine, cosine);
  const V sigma = pressure_under_rim(laws, in, at, parts, in.radius * (cosine - at.cos_f));
  add_nodes(laws, in, at, parts, front, sine, cosine, sigma, weight * front_length, sum);
  const V rear = at.theta_r + t * rear_length;
  rim_sincos(rear, sine, cosine);
  add_nodes(laws, in, at, parts, rear, sine, cosine, sigma, weight * rear_length, sum);
}

template <class V>
struct LaneForces {
  V pull, lateral, vertical, torque;
};

// The forces from the integrals, and what does not come from them: grousers, bulldozing.
template <class V>
LaneForces<V> total_forces(const WheelValues<V>& in, const ContactAngles<V>& at, const LawParts& parts,
                           const ContactIntegrals<V>& sum) {
  const V area = in.width * in.radius;
  LaneForces<V> f{area * (sum.tau_cos - sum.sigma_sin), area * sum.tau_y,
                  area * (sum.sigma_cos + sum.tau_sin), area * in.radius * sum.tau};
  if (parts.grousers) {
    const V per_radian =
        grouser_force_n(in.width, in.grouser_height, in.unit_weight, in.cohesion, at.tan_phi) *
        in.grouser_count * V(0.5 / M_PI);
    f.pull += per_radian * sum.m_cos;
    f.vertical += per_radian * sum.m_sin;
    f.torque += per_radian * sum.m * grouser_arm_m(in.radius, in.grouser_height);
  }
  if (parts.bulldozing || parts.side_bulldozing) {
    // Against the motion over the ground; a wheel that spins on the spot pushes nothing.
    const V speed = sqrt(in.forward * in.forward + in.leftward * in.leftward +
                         V(kStandingSpeedRatio * kStandingSpeedRatio));
    if (parts.bulldozing) {
      const V z = in.radius * (V(1.0) - at.cos_f);
      f.pull -= in.bulldozing * front_share(in.forward / speed) *
                passive_pressure_n(in.width, z, in.unit_weight, in.cohesion, at.tan_phi);
    }
    if (parts.side_bulldozing)
      f.lateral -= in.side_bulldozing * (in.leftward / speed) *
                   early_mobilisation(in.forward, in.leftward, in.side_mobilised) *
                   side_wall_force_n(in.radius, in.theta_f, at.sin_f, at.cos_f, in.unit_weight, in.cohesion,
                                     in.phi, at.tan_phi);
  }
  return f;
}

// A wheel gives its axle no more than the ground gives the wheel: T w >= F_x v_x + F_y v_y. Thrust of tall
// cleats and friction on a wall act at arms that do not turn at the speed at which soil slides there, and
// would break this.
template <class V>
LaneForces<V> dissipating(const WheelValues<V>& in, LaneForces<V> f) {
  f.torque = max(f.torque, in.radius * (in.forward * f.pull + in.leftward * f.lateral));
  return f;
}

}  // namespace slipway::sim
