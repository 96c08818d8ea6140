#pragma once

#include <cmath>

#include "sim/soil/digging_law.h"
#include "sim/soil/grouser_law.h"
#include "sim/soil/inclined_load_law.h"
#include "sim/soil/ploughing_law.h"
#include "sim/wheel/wheel_law.h"

// What cleats that hold soil between them, digging, inclined load and ploughing make of a wheel's contact,
// around the law of wheel_law.h. Over packs like that.
namespace slipway::sim {

// The wheel as the law of the contact sees it, and the ground around it.
template <class V>
struct ClosedContact {
  // With the radius at which the soil is sheared, the motion per that radius' speed, the entry angle at the
  // bottom of what was dug, and the stiffness that inclined load leaves.
  WheelValues<V> in;
  V theta_e, sin_e, cos_e;  // where the ground's surface meets the wheel
  V sin_f, cos_f;           // of the entry angle in `in`
  V depth_m, dug_m;
  V speed;  // |v| over the shearing radius' speed
  V tan_phi;
};

// z = r (1 - cos theta_f) is the depth of the wheel's lowest point, whose radius is the shearing one.
template <class V>
ClosedContact<V> closed_contact(const WheelValues<V>& in, const ClosureValues<V>& by) {
  ClosedContact<V> out;
  out.in = in;
  out.tan_phi = tan(in.phi);
  out.in.radius = shear_radius_m(in.radius, in.grouser_height, by.cleats, by.shear_share, by.shear_by_spacing,
                                 out.tan_phi);
  const V radius_ratio = in.radius / out.in.radius;
  out.in.forward = in.forward * radius_ratio;
  out.in.leftward = in.leftward * radius_ratio;
  out.speed = sqrt(out.in.forward * out.in.forward + out.in.leftward * out.in.leftward);
  out.dug_m = dug_depth_m(by.rim_dug, by.rim_slip, by.cleat_dug, by.per_cleat_limit, by.dug_sideways,
                          out.in.forward, out.speed);
  out.cos_e = V(1.0) - radius_ratio * (V(1.0) - cos(in.theta_f));
  out.theta_e = acos(out.cos_e);
  out.sin_e = sqrt(max(V(0.0), V(1.0) - out.cos_e * out.cos_e));
  out.depth_m = out.in.radius * (V(1.0) - out.cos_e);
  out.cos_f = min(V(1.0), out.cos_e + out.dug_m / out.in.radius);
  out.sin_f = sqrt(max(V(0.0), V(1.0) - out.cos_f * out.cos_f));
  out.in.theta_f = acos(out.cos_f);
  out.in.stiffness = in.stiffness * inclined_load_share(by.softening, out.in.forward, out.speed);
  return out;
}

// The contact ends where the rim is upright, however deep it stands.
template <class V>
void close_angles(const ClosureValues<V>& by, const ClosedContact<V>& closed, ContactAngles<V>& at) {
  at.top = min(closed.in.theta_f, V(0.5 * M_PI));
  at.theta_r = -closed.in.exit_ratio * at.top;
  at.theta_m = max(at.theta_r, min(at.theta_m, V(0.99) * at.top));
  at.slip_directed = by.slip_directed;
  at.cleat_braking = by.cleat_braking;
  at.cleat_per_pa =
      by.cleat_surcharge * grouser_surcharge_per_pa(closed.in.grouser_height, closed.in.unit_weight,
                                                    closed.in.cohesion, closed.tan_phi);
}

// Takes what it costs to carry out the soil that was dug (digging_law.h).
template <class V>
void add_digging(const ClosedContact<V>& closed, LaneForces<V>& f) {
  const WheelValues<V>& in = closed.in;
  const V speed = sqrt(closed.speed * closed.speed + V(kStandingSpeedRatio * kStandingSpeedRatio));
  const V carried =
      front_share(in.forward / speed) *
      passive_pressure_n(in.width, min(closed.dug_m, closed.depth_m), in.unit_weight, V(0.0), closed.tan_phi);
  f.pull -= carried;
  f.torque += in.rim_friction * closed.tan_phi * carried * in.radius;
}

// Adds what is pushed before the front and the wall, and the wall's friction, which acts at a third of the
// depth above the lowest point: where the pressure has its centre.
template <class V>
void add_ploughing(const ClosedContact<V>& closed, const ClosureValues<V>& by, LaneForces<V>& f) {
  const WheelValues<V>& in = closed.in;
  const V speed = sqrt(closed.speed * closed.speed + V(kStandingSpeedRatio * kStandingSpeedRatio));
  const V heap = V(0.5) * in.unit_weight * heap_factor(by.heap, by.per_heap_slip, closed.speed);
  const V pushed = max(V(0.0), closed.depth_m - closed.dug_m);
  f.pull -= by.plough_front * heap * in.width * pushed * pushed * front_share(in.forward / speed);
  const V across = by.plough_wall * heap * (in.leftward / speed) *
                   wall_depth_square_m3(in.radius, closed.theta_e, closed.sin_e, closed.cos_e);
  f.lateral -= across;
  const V friction = by.wall_friction * abs(across) *
                     wall_friction_share(by.wall_turn, by.wall_yield, in.forward, in.leftward);
  f.pull += friction;
  f.torque += friction * max(V(0.0), in.radius - V(1.0 / 3.0) * closed.depth_m);
}

}  // namespace slipway::sim
