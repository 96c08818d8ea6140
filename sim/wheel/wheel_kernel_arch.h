#pragma once

// Compiled once for each instruction set, each in a file of its own with its own flags. Every function
// template here carries the set in its type, so that the linker can't mix them up.
#include "sim/wheel/arc_quadrature.h"
#include "sim/wheel/wheel_kernel.h"
#include "sim/wheel/wheel_law.h"

namespace slipway::sim {
namespace {

using Pack = xsimd::batch<double, SLIPWAY_KERNEL_ARCH>;
constexpr std::size_t kLanes = Pack::size;
constexpr std::size_t kFields = sizeof(WheelNumbers) / sizeof(double);

static_assert(sizeof(WheelCase<Pack>) == (kFields + 1) * sizeof(Pack), "WheelCase has tan_phi besides");

// Same order of fields as WheelNumbers, and tan_phi behind phi.
WheelCase<Pack> case_of(const Pack* f) {
  return {f[0],       f[1],  f[2],  f[3],  f[4],  f[5],  f[6],  f[7],  f[8],  f[9],  f[10],
          tan(f[10]), f[11], f[12], f[13], f[14], f[15], f[16], f[17], f[18], f[19], f[20],
          f[21],      f[22], f[23], f[24], f[25], f[26], f[27], f[28], f[29]};
}

void one_wheel(const WheelNumbers& numbers, const LawParts& parts, WheelForces& out) {
  const double* fields = &numbers.radius;
  Pack spread[kFields];
  for (std::size_t k = 0; k < kFields; ++k) spread[k] = Pack(fields[k]);
  const WheelCase<Pack> in = case_of(spread);
  const ContactAngles<Pack> at = contact_angles(in);
  ContactIntegrals<Pack> sum;
  for (std::size_t k = 0; k < kArcNodes; k += kLanes)
    add_both_arcs(in, at, parts, Pack::load_aligned(&kArcQuadrature.node[k]),
                  Pack::load_aligned(&kArcQuadrature.weight[k]), sum);
  for (Pack* part : {&sum.tau, &sum.tau_cos, &sum.tau_sin, &sum.tau_y, &sum.sigma_cos, &sum.sigma_sin, &sum.m,
                     &sum.m_cos, &sum.m_sin})
    *part = Pack(hadd(*part));
  const LaneForces<Pack> f = total_forces(in, at, parts, sum);
  out = {f.pull.get(0), f.lateral.get(0), f.vertical.get(0), f.torque.get(0)};
}

void many_wheels(const WheelNumbers* wheels, const LawParts& parts, WheelForces* out, std::size_t count) {
  for (std::size_t first = 0; first < count; first += kLanes) {
    const std::size_t here = count - first < kLanes ? count - first : kLanes;
    alignas(64) double columns[kFields][kLanes];
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const double* fields = &wheels[first + (lane < here ? lane : 0)].radius;
      for (std::size_t k = 0; k < kFields; ++k) columns[k][lane] = fields[k];
    }
    Pack packed[kFields];
    for (std::size_t k = 0; k < kFields; ++k) packed[k] = Pack::load_aligned(columns[k]);
    const WheelCase<Pack> in = case_of(packed);
    const ContactAngles<Pack> at = contact_angles(in);
    ContactIntegrals<Pack> sum;
    for (std::size_t k = 0; k < kArcNodes; ++k)
      add_both_arcs(in, at, parts, Pack(kArcQuadrature.node[k]), Pack(kArcQuadrature.weight[k]), sum);
    const LaneForces<Pack> f = total_forces(in, at, parts, sum);
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
