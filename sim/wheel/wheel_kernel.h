#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "sim/soil/soil_in_force.h"
#include "sim/wheel/wheel_forces.h"

namespace slipway::sim {

// One wheel, its soil and its motion as the kernel computes with them, for one wheel (V a double) or for a
// pack of them: field by field as in WheelGeometry, Soil and WheelMotion.
template <class V>
struct WheelValues {
  V radius, width, rim_friction, grouser_height, grouser_count, per_cleat_shear, cleat_by_slip;
  // p = stiffness z^n, for Bekker's law with stiffness = k_c / b + k_phi; per_shear: 1 / K.
  V stiffness, n, cohesion, phi, per_shear_x, per_shear_y;
  V c1, c2, n1, n1_skid, n1_lateral, exit_ratio, coupling;
  V unit_weight, bulldozing, side_bulldozing;
  V side_mobilised;  // the squared sine of Soil::side_mobilised_rad
  V crust_strength, per_crust_depth, hardpan_modulus, hardpan_depth;
  V theta_f, forward, leftward;
};

// The numbers of the closures for wheels that dig, plough and skid: wheel_closures.h.
template <class V>
struct ClosureValues {
  V shear_share, shear_by_spacing, cleats;  // where the soil is sheared: shear_radius_m()
  V cleat_braking;
  V cleat_surcharge;  // the share of the rim's pressure beside a cleat that presses on what it pushes
  V slip_directed, softening;
  V rim_dug, rim_slip, cleat_dug, per_cleat_limit, dug_sideways;
  // Factors of gamma z^2 b / 2 and of gamma / 2 times the wall's integral of depth squared.
  V plough_front, plough_wall;
  V heap, per_heap_slip, wall_friction, wall_turn, wall_yield;
};

template <class V>
inline constexpr std::array kClosureMembers{
    &ClosureValues<V>::shear_share,   &ClosureValues<V>::shear_by_spacing, &ClosureValues<V>::cleats,
    &ClosureValues<V>::cleat_braking, &ClosureValues<V>::cleat_surcharge,  &ClosureValues<V>::slip_directed,
    &ClosureValues<V>::softening,     &ClosureValues<V>::rim_dug,          &ClosureValues<V>::rim_slip,
    &ClosureValues<V>::cleat_dug,     &ClosureValues<V>::per_cleat_limit,  &ClosureValues<V>::dug_sideways,
    &ClosureValues<V>::plough_front,  &ClosureValues<V>::plough_wall,      &ClosureValues<V>::heap,
    &ClosureValues<V>::per_heap_slip, &ClosureValues<V>::wall_friction,    &ClosureValues<V>::wall_turn,
    &ClosureValues<V>::wall_yield};
static_assert(sizeof(ClosureValues<double>) == kClosureMembers<double>.size() * sizeof(double),
              "a number of the closures is missing in the list that spreads them");

// Every one of them, so that they can be spread over packs.
template <class V>
inline constexpr std::array kWheelMembers{&WheelValues<V>::radius,
                                          &WheelValues<V>::width,
                                          &WheelValues<V>::rim_friction,
                                          &WheelValues<V>::grouser_height,
                                          &WheelValues<V>::grouser_count,
                                          &WheelValues<V>::per_cleat_shear,
                                          &WheelValues<V>::cleat_by_slip,
                                          &WheelValues<V>::stiffness,
                                          &WheelValues<V>::n,
                                          &WheelValues<V>::cohesion,
                                          &WheelValues<V>::phi,
                                          &WheelValues<V>::per_shear_x,
                                          &WheelValues<V>::per_shear_y,
                                          &WheelValues<V>::c1,
                                          &WheelValues<V>::c2,
                                          &WheelValues<V>::n1,
                                          &WheelValues<V>::n1_skid,
                                          &WheelValues<V>::n1_lateral,
                                          &WheelValues<V>::exit_ratio,
                                          &WheelValues<V>::coupling,
                                          &WheelValues<V>::unit_weight,
                                          &WheelValues<V>::bulldozing,
                                          &WheelValues<V>::side_bulldozing,
                                          &WheelValues<V>::side_mobilised,
                                          &WheelValues<V>::crust_strength,
                                          &WheelValues<V>::per_crust_depth,
                                          &WheelValues<V>::hardpan_modulus,
                                          &WheelValues<V>::hardpan_depth,
                                          &WheelValues<V>::theta_f,
                                          &WheelValues<V>::forward,
                                          &WheelValues<V>::leftward};
static_assert(sizeof(WheelValues<double>) == kWheelMembers<double>.size() * sizeof(double),
              "a number of the kernel is missing in the list that spreads them");

// The laws of a wheel's soil that are not Bekker's and Janosi and Hanamoto's. Both rows are null for those.
struct ChosenLaws {
  const PressureSinkageLaw* pressure;
  const ShearLaw* shear;
  double per_depth;                // p = stiffness (z per_depth)^n
  LawParameters pressure_numbers;  // of a law that is no power of depth; its stiffness is a factor
  ShearForm shear_form;
  LawParameters shear_parameters;
};

// Without initial values, as arrays of them are filled one by one in the solvers' loops.
struct WheelNumbers : WheelValues<double> {
  ChosenLaws laws;
  ClosureValues<double> closures;
  bool closed;  // any closure is at work; otherwise they are at their neutral values
};

WheelNumbers numbers_of(const WheelGeometry& wheel, const Soil& soil, double entry_angle_rad,
                        const WheelMotion& motion);

// Makes the numbers of a wheel outside all tracks those that it has in a track, but for its angle and motion.
void put_in_track(const WheelNumbers& fresh, const TrackFactors& track, WheelNumbers& numbers);

// Which parts of the law are at work in any of the wheels: the others are left out.
struct LawParts {
  bool lateral = false, independent = false, coupled = false, grousers = false, bulldozing = false,
       side_bulldozing = false, crust = false, hardpan = false;
  // Any wheel's soil has other laws than Bekker's and Janosi and Hanamoto's.
  bool chosen_laws = false;
  bool closures = false;
  // With closures: in any wheel the shear's direction is not the sliding's alone.
  bool undirected = false;

  void include(const WheelNumbers& in);
};

// The law compiled for one instruction set.
struct WheelKernel {
  const char* instruction_set;
  std::size_t lanes;  // wheels that `many` computes at a time
  void (*one)(const WheelNumbers& in, const LawParts& parts, WheelForces& out);
  void (*many)(const WheelNumbers* in, const LawParts& parts, WheelForces* out, std::size_t count);
};

// The fastest kernel that this machine runs. AVX2 and AVX-512 agree to the bit, SSE2, which has no fused
// multiply-add, to rounding (tests).
const WheelKernel& wheel_kernel();
// Forces of several wheels, each on its own soil: spans of one length. Takes them in packs and, where less
// than half a pack is left over, one by one.
void wheel_forces(std::span<const WheelNumbers> wheels, std::span<WheelForces> forces);
// All kernels this machine runs, slowest first.
int wheel_kernels(const WheelKernel** out, int capacity);

}  // namespace slipway::sim
