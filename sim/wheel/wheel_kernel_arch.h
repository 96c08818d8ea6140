#pragma once

// Compiled once for each instruction set, each in a file of its own with its own flags. Every function
// template here carries the set in its type, so that the linker can't mix them up.
#include <utility>

#include "sim/wheel/arc_quadrature.h"
#include "sim/wheel/chosen_laws.h"
#include "sim/wheel/wheel_kernel.h"
#include "sim/wheel/wheel_law.h"

namespace slipway::sim {
namespace {

using Pack = xsimd::batch<double, SLIPWAY_KERNEL_ARCH>;
constexpr std::size_t kLanes = Pack::size;
constexpr std::size_t kValues = kWheelMembers<double>.size();

// One wheel in every lane.
WheelValues<Pack> in_every_lane(const WheelValues<double>& wheel) {
  WheelValues<Pack> packed;
  [&]<std::size_t... k>(std::index_sequence<k...>) {
    ((packed.*kWheelMembers<Pack>[k] = Pack(wheel.*kWheelMembers<double>[k])), ...);
  }
  (std::make_index_sequence<kValues>{});
  return packed;
}

// A wheel in each lane.
WheelValues<Pack> in_lanes(const std::array<const WheelNumbers*, kLanes>& wheels) {
  alignas(64) double columns[kValues][kLanes];
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    const WheelValues<double>& wheel = *wheels[lane];
    [&]<std::size_t... k>(std::index_sequence<k...>) {
      ((columns[k][lane] = wheel.*kWheelMembers<double>[k]), ...);
    }
    (std::make_index_sequence<kValues>{});
  }
  WheelValues<Pack> packed;
  [&]<std::size_t... k>(std::index_sequence<k...>) {
    ((packed.*kWheelMembers<Pack>[k] = Pack::load_aligned(columns[k])), ...);
  }
  (std::make_index_sequence<kValues>{});
  return packed;
}

// The nodes of one wheel's arcs in packs.
template <class Laws>
void one_wheel_by(const Laws& laws, const WheelNumbers& numbers, const LawParts& parts, WheelForces& out) {
  const WheelValues<Pack> in = in_every_lane(numbers);
  const ContactAngles<Pack> at = contact_angles(in);
  ContactIntegrals<Pack> sum;
  for (std::size_t k = 0; k < kArcNodes; k += kLanes)
    add_both_arcs(laws, in, at, parts, Pack::load_aligned(&kArcQuadrature.node[k]),
                  Pack::load_aligned(&kArcQuadrature.weight[k]), sum);
  for (Pack* part : {&sum.tau, &sum.tau_cos, &sum.tau_sin, &sum.tau_y, &sum.sigma_cos, &sum.sigma_sin, &sum.m,
                     &sum.m_cos, &sum.m_sin})
    *part = Pack(hadd(*part));
  const LaneForces<Pack> f = total_forces(in, at, parts, sum);
  out = {f.pull.get(0), f.lateral.get(0), f.vertical.get(0), f.torque.get(0)};
}

// The same node of several wheels in a pack.
template <class Laws>
LaneForces<Pack> lanes_by(const Laws& laws, const WheelValues<Pack>& in, const LawParts& parts) {
  const ContactAngles<Pack> at = contact_angles(in);
  ContactIntegrals<Pack> sum;
  for (std::size_t k = 0; k < kArcNodes; ++k)
    add_both_arcs(laws, in, at, parts, Pack(kArcQuadrature.node[k]), Pack(kArcQuadrature.weight[k]), sum);
  return total_forces(in, at, parts, sum);
}

void one_wheel(const WheelNumbers& numbers, const LawParts& parts, WheelForces& out) {
  if (!parts.chosen_laws) return one_wheel_by(DefaultLaws{}, numbers, parts, out);
  std::array<const WheelNumbers*, kLanes> lanes;
  lanes.fill(&numbers);
  one_wheel_by(ChosenLawsInLanes<Pack, kLanes>(lanes), numbers, parts, out);
}

void many_wheels(const WheelNumbers* wheels, const LawParts& parts, WheelForces* out, std::size_t count) {
  for (std::size_t first = 0; first < count; first += kLanes) {
    const std::size_t here = count - first < kLanes ? count - first : kLanes;
    std::array<const WheelNumbers*, kLanes> lanes;
    for (std::size_t lane = 0; lane < kLanes; ++lane) lanes[lane] = &wheels[first + (lane < here ? lane : 0)];
    const WheelValues<Pack> in = in_lanes(lanes);
    const LaneForces<Pack> f = parts.chosen_laws ? lanes_by(ChosenLawsInLanes<Pack, kLanes>(lanes), in, parts)
                                                 : lanes_by(DefaultLaws{}, in, parts);
    alignas(64) double pull[kLanes], lateral[kLanes], vertical[kLanes], torque[kLanes];
    f.pull.store_aligned(pull);
    f.lateral.store_aligned(lateral);
    f.vertical.store_aligned(vertical);
    f.torque.store_aligned(torque);
    for (std::size_t lane = 0; lane < here; ++lane)
      out[first + lane] = {pull[lane], lateral[lane], vertical[lane], torque[lane]};
  }
}

}  // namespace

extern const WheelKernel SLIPWAY_KERNEL_NAME;
const WheelKernel SLIPWAY_KERNEL_NAME{SLIPWAY_KERNEL_ARCH::name(), kLanes, &one_wheel, &many_wheels};

}  // namespace slipway::sim
