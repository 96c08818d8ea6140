#include "sim/wheel/wheel_forces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "sim/soil/grouser_law.h"
#include "sim/wheel/wheel_kernel.h"

namespace slipway::sim {
namespace {

// Fills in what the chosen laws make of the soil under this wheel, and the stiffness that goes with them.
void choose_laws(const WheelGeometry& wheel, const Soil& soil, WheelNumbers& numbers) {
  ChosenLaws& laws = numbers.laws;
  laws.pressure = soil.pressure_law.row;
  laws.shear = soil.shear_law.row;
  if (laws.pressure != nullptr) {
    const ContactSize contact{.width_m = wheel.width_m, .radius_m = wheel.radius_m};
    if (laws.pressure->pressure_pa != nullptr) {
      laws.pressure_numbers = laws.pressure->numbers(soil, contact);
      numbers.stiffness = soil.pressure_law.stiffening;
    } else {
      const PressureForm form = soil.pressure_form(contact);
      numbers.stiffness = form.stiffness;
      laws.per_depth = form.per_depth_1_m;
    }
  }
  if (laws.shear == nullptr) return;
  laws.shear_parameters = soil.shear_law.parameters;
  if (laws.shear->mobilised == nullptr) laws.shear_form = laws.shear->form(soil.shear_law.parameters);
}

}  // namespace

namespace {

ClosureValues<double> closures_of(const WheelGeometry& wheel, const Soil& soil) {
  const Digging& digging = soil.digging;
  const Ploughing& ploughing = soil.ploughing;
  return {.shear_share = wheel.grousers.shear_share,
          .shear_by_spacing = wheel.grousers.shear_by_spacing,
          .cleats = wheel.grousers.count,
          .cleat_braking = wheel.grousers.braking,
          .cleat_surcharge = wheel.grousers.surcharge,
          .slip_directed = soil.slip_directed,
          .softening = soil.inclined_softening,
          .rim_dug = digging.rim_share * wheel.radius_m,
          .rim_slip = digging.rim_slip,
          .cleat_dug = digging.cleat_share * wheel.grousers.height_m,
          .per_cleat_limit = 1.0 / digging.cleat_limit,
          .dug_sideways = digging.sideways,
          .plough_front = ploughing.front,
          .plough_wall = ploughing.wall,
          .heap = ploughing.heap,
          .per_heap_slip = 1.0 / ploughing.heap_slip,
          .wall_friction = ploughing.wall_friction,
          .wall_turn = ploughing.wall_turn,
          .wall_yield = ploughing.wall_yield};
}

}  // namespace

double shear_radius_m(const WheelGeometry& wheel, const Soil& soil) {
  const Grousers& cleats = wheel.grousers;
  return shear_radius_m(wheel.radius_m, cleats.height_m, cleats.count, cleats.shear_share,
                        cleats.shear_by_spacing, std::tan(soil.friction_angle_rad));
}

double max_entry_angle_rad(const Soil& soil) {
  return soil.ploughing.wall > 0.0 ? kMaxPloughingAngleRad : kMaxEntryAngleRad;
}

WheelNumbers numbers_of(const WheelGeometry& wheel, const Soil& soil, double entry_angle_rad,
                        const WheelMotion& motion) {
  const Grousers& cleats = wheel.grousers;
  const bool sheared_beyond_rim =
      cleats.height_m > 0.0 && (cleats.shear_share > 0.0 || cleats.shear_by_spacing > 0.0);
  const double side_sine = soil.side_bulldozing != 0.0 ? std::sin(soil.side_mobilised_rad) : 1.0;
  const double per_shear_x = soil.shear_strength_ratio / soil.shear_modulus_x_m,
               per_shear_y = soil.shear_strength_ratio / soil.shear_modulus_y_m;
  WheelNumbers numbers{{.radius = wheel.radius_m,
                        .width = wheel.width_m,
                        .rim_friction = wheel.rim_friction,
                        .grouser_height = wheel.grousers.height_m,
                        .grouser_count = wheel.grousers.count * wheel.grousers.thrust,
                        .per_cleat_shear = per_shear_x / wheel.grousers.mobilisation,
                        .cleat_by_slip = wheel.grousers.by_slip,
                        .stiffness = soil.pressure.stiffness(wheel.width_m),
                        .n = soil.pressure.n,
                        .cohesion = soil.shear_strength_ratio * soil.cohesion_pa,
                        .phi = soil.friction_angle_rad,
                        .per_shear_x = per_shear_x,
                        .per_shear_y = per_shear_y,
                        .c1 = soil.c1,
                        .c2 = soil.c2,
                        .n1 = soil.n1,
                        .n1_skid = soil.n1_skid,
                        .n1_lateral = soil.n1_lateral,
                        .exit_ratio = soil.exit_angle_ratio,
                        .coupling = soil.shear_coupling,
                        .unit_weight = soil.unit_weight_n_m3(),
                        .bulldozing = soil.bulldozing,
                        .side_bulldozing = soil.side_bulldozing,
                        .side_mobilised = side_sine * side_sine,
                        .crust_strength = soil.crust.strength_pa,
                        .per_crust_depth = 1.0 / soil.crust.depth_m,
                        .hardpan_modulus = soil.hardpan.modulus_pa_m,
                        .hardpan_depth = soil.hardpan.depth_m,
                        .theta_f = entry_angle_rad,
                        .forward = motion.forward,
                        .leftward = motion.leftward},
                       {.pressure = nullptr,
                        .shear = nullptr,
                        .per_depth = 1.0,
                        .pressure_numbers = {},
                        .shear_form = {1.0, 0.0},
                        .shear_parameters = {}},
                       closures_of(wheel, soil),
                       soil.has_closures() || sheared_beyond_rim || wheel.grousers.braking != 1.0 ||
                           wheel.grousers.surcharge > 0.0};
  if (soil.pressure_law.row != nullptr || soil.shear_law.row != nullptr) choose_laws(wheel, soil, numbers);
  return numbers;
}

void put_in_track(const WheelNumbers& fresh, const TrackFactors& track, WheelNumbers& numbers) {
  numbers.stiffness = track.stiffness * fresh.stiffness;
  numbers.bulldozing = track.bulldozing * fresh.bulldozing;
  numbers.cohesion = track.shear * fresh.cohesion;
  numbers.per_shear_x = track.shear * fresh.per_shear_x;
  numbers.per_shear_y = track.shear * fresh.per_shear_y;
  numbers.per_cleat_shear = track.shear * fresh.per_cleat_shear;
}

WheelForces wheel_forces(const WheelGeometry& wheel, const Soil& soil, double entry_angle_rad,
                         const WheelMotion& motion) {
  const WheelNumbers numbers = numbers_of(wheel, soil, entry_angle_rad, motion);
  LawParts parts;
  parts.include(numbers);
  WheelForces forces;
  wheel_kernel().one(numbers, parts, forces);
  return forces;
}

void wheel_forces(const WheelGeometry& wheel, std::span<const Soil> soils,
                  std::span<const double> entry_angles_rad, std::span<const WheelMotion> motions,
                  std::span<WheelForces> forces) {
  const std::size_t count = soils.size();
  if (entry_angles_rad.size() != count || motions.size() != count || forces.size() != count)
    throw std::invalid_argument("wheel_forces: one entry angle, motion and force a soil");
  constexpr std::size_t kChunk = 64;
  std::array<WheelNumbers, kChunk> numbers;
  for (std::size_t first = 0; first < count; first += kChunk) {
    const std::size_t here = std::min(kChunk, count - first);
    for (std::size_t k = 0; k < here; ++k)
      ::new (&numbers[k])  // in its place: it is large
          WheelNumbers(numbers_of(wheel, soils[first + k], entry_angles_rad[first + k], motions[first + k]));
    wheel_forces({numbers.data(), here}, forces.subspan(first, here));
  }
}

void wheel_forces(std::span<const WheelNumbers> wheels, std::span<WheelForces> forces) {
  if (forces.size() != wheels.size()) throw std::invalid_argument("wheel_forces: one force a wheel");
  const WheelKernel& kernel = wheel_kernel();
  LawParts parts;
  for (const WheelNumbers& wheel : wheels) parts.include(wheel);
  // The same wheels by packs whatever the kernel's width, since a wheel in a pack may differ in the last bit
  // from one alone.
  constexpr std::size_t kPack = 8;
  const std::size_t rest = wheels.size() % kPack;
  const std::size_t packed = 2 * rest < kPack ? wheels.size() - rest : wheels.size();
  kernel.many(wheels.data(), parts, forces.data(), packed);
  for (std::size_t k = packed; k < wheels.size(); ++k) kernel.one(wheels[k], parts, forces[k]);
}

double sinkage_m(double radius_m, double entry_angle_rad) {
  const double half = std::sin(0.5 * entry_angle_rad);
  return 2.0 * radius_m * half * half;
}

double entry_angle_rad(double radius_m, double sinkage_m) {
  return 2.0 * std::asin(std::sqrt(std::clamp(0.5 * sinkage_m / radius_m, 0.0, 1.0)));
}

}  // namespace slipway::sim
