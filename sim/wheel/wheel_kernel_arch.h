#pragma once

// Compiled once for each instruction set, each in a file of its own with its own flags. Every function
// template here carries the set in its type, so that the linker can't mix them up.
#include <cstddef>
#include <cstring>
#include <limits>
#include <type_traits>
#include <utility>

#include "sim/wheel/arc_quadrature.h"
#include "sim/wheel/chosen_laws.h"
#include "sim/wheel/wheel_closures.h"
#include "sim/wheel/wheel_kernel.h"
#include "sim/wheel/wheel_law.h"

// xsimd's logarithm (after FreeBSD's e_log.c) with its only sum of two products taken in one order. xsimd 10
// has no fused multiply-add for AVX-512 and leaves it to g++, which fused the other product: one logarithm in
// some thousand had another last bit than with AVX2. The law's other functions agree to the bit.
namespace xsimd {

inline batch<double, SLIPWAY_KERNEL_ARCH> log(const batch<double, SLIPWAY_KERNEL_ARCH>& x) noexcept {
  using V = batch<double, SLIPWAY_KERNEL_ARCH>;
  using Whole = as_integer_t<V>;
  const auto fused = [](const V& a, const V& b, const V& c) {
#ifdef __AVX512F__
    return V(_mm512_fmadd_pd(a, b, c));
#else
    return fma(a, b, c);
#endif
  };
  // x = 2^k (1 + f), 1 + f from sqrt(1/2) to sqrt(2).
  const Whole bits = bitwise_cast<Whole>(x);
  const Whole high = (bits >> 32) + (0x3ff00000 - 0x3fe6a09e);
  const V k = to_float((high >> 20) - Whole(0x3ff));
  const Whole scaled = ((high & Whole(0x000fffff)) + Whole(0x3fe6a09e)) << 32 | (bits & Whole(0xffffffff));
  const V f = bitwise_cast<V>(scaled) - V(1.0);
  const V half_square = V(0.5) * f * f;
  const V s = f / (V(2.0) + f);
  const V z = s * s, w = z * z;
  const V odd = w * fused(w, fused(w, V(1.531383769920937332e-01), V(2.222219843214978396e-01)),
                          V(3.999999999940941908e-01));
  const V even = fused(w,
                       fused(w, fused(w, V(1.479819860511658591e-01), V(1.818357216161805012e-01)),
                             V(2.857142874366239149e-01)),
                       V(6.666666666666735130e-01));
  const V rest = fused(z, even, odd);
  const V log2_high(6.93147180369123816490e-01), log2_low(1.90821492927058770002e-10);
  const V value = fused(k, log2_high, fused(s, half_square + rest, k * log2_low) - half_square + f);
  const V at_ends = select(x == V(0.0), V(-std::numeric_limits<double>::infinity()), value);
  return select(x >= V(0.0) && x <= V(std::numeric_limits<double>::max()), at_ends,
                select(x > V(0.0), x, V(std::numeric_limits<double>::quiet_NaN())));
}

}  // namespace xsimd

namespace slipway::sim {
namespace {

using Pack = xsimd::batch<double, SLIPWAY_KERNEL_ARCH>;
constexpr std::size_t kLanes = Pack::size;

template <template <class> class Values, class V>
constexpr auto& members() {
  if constexpr (std::is_same_v<Values<V>, WheelValues<V>>)
    return kWheelMembers<V>;
  else
    return kClosureMembers<V>;
}

// The values of one wheel in every lane.
template <template <class> class Values>
Values<Pack> in_every_lane(const Values<double>& wheel) {
  Values<Pack> packed;
  [&]<std::size_t... k>(std::index_sequence<k...>) {
    ((packed.*members<Values, Pack>()[k] = Pack(wheel.*members<Values, double>()[k])), ...);
  }
  (std::make_index_sequence<members<Values, double>().size()>{});
  return packed;
}

const WheelValues<double>& values_in(const WheelNumbers& wheel, const WheelValues<Pack>* /*kind*/) {
  return wheel;
}
const ClosureValues<double>& values_in(const WheelNumbers& wheel, const ClosureValues<Pack>* /*kind*/) {
  return wheel.closures;
}

// A register as the compiler's own vector, which can be shuffled.
typedef double Register __attribute__((vector_size(kLanes * sizeof(double))));

// One from each in turn: a0 b0 a1 b1 ..., of the lower or the upper halves.
template <std::size_t... k>
Register interleaved_low(Register a, Register b, std::index_sequence<k...> /*lanes*/) {
  return __builtin_shufflevector(a, b, (k / 2 + (k % 2) * kLanes)...);
}
template <std::size_t... k>
Register interleaved_high(Register a, Register b, std::index_sequence<k...> /*lanes*/) {
  return __builtin_shufflevector(a, b, (kLanes / 2 + k / 2 + (k % 2) * kLanes)...);
}

// Rows of so many numbers become columns: each pass of interleaving the first half of the rows with the
// second moves one bit of a number's row into its column.
void transpose(std::array<Register, kLanes>& rows) {
  constexpr auto kAll = std::make_index_sequence<kLanes>{};
  for (std::size_t pass = 1; pass < kLanes; pass *= 2) {
    const std::array<Register, kLanes> before = rows;
    for (std::size_t k = 0; k < kLanes / 2; ++k) {
      rows[2 * k] = interleaved_low(before[k], before[k + kLanes / 2], kAll);
      rows[2 * k + 1] = interleaved_high(before[k], before[k + kLanes / 2], kAll);
    }
  }
}

// The values of a wheel in each lane. They lie one after another, without gaps (wheel_kernel.h asserts it),
// in the wheels as in the pack, and are turned block by block in registers: to store them one by one and to
// load them across would wait for every store.
template <template <class> class Values>
Values<Pack> in_lanes(const std::array<const WheelNumbers*, kLanes>& wheels) {
  constexpr std::size_t kValues = members<Values, double>().size();
  static_assert(kValues >= kLanes && sizeof(Values<Pack>) == kValues * sizeof(Register));
  Values<Pack> packed;
  for (std::size_t block = 0; block < kValues; block += kLanes) {
    // The last block begins early enough to end with the values.
    const std::size_t first = block + kLanes <= kValues ? block : kValues - kLanes;
    std::array<Register, kLanes> rows;
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const Values<double>& wheel = values_in(*wheels[lane], static_cast<const Values<Pack>*>(nullptr));
      std::memcpy(&rows[lane], reinterpret_cast<const std::byte*>(&wheel) + first * sizeof(double),
                  sizeof(Register));
    }
    transpose(rows);
    std::memcpy(reinterpret_cast<std::byte*>(&packed) + first * sizeof(Register), rows.data(), sizeof(rows));
  }
  return packed;
}

constexpr std::size_t kNodePacks = kArcNodes / kLanes;  // packs that hold the nodes of an arc

// The sums over all nodes in every lane. Halves are added until one pack is left, as the widest instruction
// set adds its halves, so that every set with fused multiply-add gives the same bits.
ContactIntegrals<Pack> sum_nodes(std::array<ContactIntegrals<Pack>, kNodePacks>& sums) {
  for (const auto part :
       {&ContactIntegrals<Pack>::tau, &ContactIntegrals<Pack>::tau_cos, &ContactIntegrals<Pack>::tau_sin,
        &ContactIntegrals<Pack>::tau_y, &ContactIntegrals<Pack>::sigma_cos,
        &ContactIntegrals<Pack>::sigma_sin, &ContactIntegrals<Pack>::m, &ContactIntegrals<Pack>::m_cos,
        &ContactIntegrals<Pack>::m_sin}) {
    for (std::size_t half = kNodePacks / 2; half > 0; half /= 2)
      for (std::size_t k = 0; k < half; ++k) sums[k].*part = sums[k].*part + sums[k + half].*part;
    sums[0].*part = Pack(hadd(sums[0].*part));
  }
  return sums[0];
}

// The nodes of one wheel's arcs in packs.
template <class Laws>
LaneForces<Pack> one_wheel_by(const Laws& laws, const WheelValues<Pack>& in, const ContactAngles<Pack>& at,
                              const LawParts& parts) {
  std::array<ContactIntegrals<Pack>, kNodePacks> sums;
  for (std::size_t k = 0; k < kNodePacks; ++k)
    add_both_arcs(laws, in, at, parts, Pack::load_aligned(&kArcQuadrature.node[k * kLanes]),
                  Pack::load_aligned(&kArcQuadrature.weight[k * kLanes]), sums[k]);
  return total_forces(in, at, parts, sum_nodes(sums));
}

// The same node of several wheels in a pack.
template <class Laws>
LaneForces<Pack> lanes_by(const Laws& laws, const WheelValues<Pack>& in, const ContactAngles<Pack>& at,
                          const LawParts& parts) {
  ContactIntegrals<Pack> sum;
  for (std::size_t k = 0; k < kArcNodes; ++k)
    add_both_arcs(laws, in, at, parts, Pack(kArcQuadrature.node[k]), Pack(kArcQuadrature.weight[k]), sum);
  return total_forces(in, at, parts, sum);
}

// Computes with the closures, where any is at work, or without. `forces` takes the values and the contact.
template <class Forces>
LaneForces<Pack> with_closures(const WheelValues<Pack>& in, const ClosureValues<Pack>& by,
                               const Forces& forces) {
  const ClosedContact<Pack> closed = closed_contact(in, by);
  ContactAngles<Pack> at = contact_angles(closed.in, closed.sin_f, closed.cos_f, closed.tan_phi);
  close_angles(by, closed, at);
  LaneForces<Pack> f = forces(closed.in, at);
  add_digging(closed, f);
  add_ploughing(closed, by, f);
  return f;
}

template <class Laws>
LaneForces<Pack> one_wheel_closed_or_not(const Laws& laws, const WheelNumbers& numbers,
                                         const LawParts& parts) {
  const WheelValues<Pack> in = in_every_lane<WheelValues>(numbers);
  const auto forces = [&](const WheelValues<Pack>& met, const ContactAngles<Pack>& at) {
    return one_wheel_by(laws, met, at, parts);
  };
  if (!parts.closures) return dissipating(in, forces(in, contact_angles(in)));
  return dissipating(in, with_closures(in, in_every_lane<ClosureValues>(numbers.closures), forces));
}

template <class Laws>
LaneForces<Pack> lanes_closed_or_not(const Laws& laws, const std::array<const WheelNumbers*, kLanes>& wheels,
                                     const LawParts& parts) {
  const WheelValues<Pack> in = in_lanes<WheelValues>(wheels);
  const auto forces = [&](const WheelValues<Pack>& met, const ContactAngles<Pack>& at) {
    return lanes_by(laws, met, at, parts);
  };
  if (!parts.closures) return dissipating(in, forces(in, contact_angles(in)));
  return dissipating(in, with_closures(in, in_lanes<ClosureValues>(wheels), forces));
}

void one_wheel(const WheelNumbers& numbers, const LawParts& parts, WheelForces& out) {
  LaneForces<Pack> f;
  if (parts.chosen_laws) {
    std::array<const WheelNumbers*, kLanes> lanes;
    lanes.fill(&numbers);
    f = one_wheel_closed_or_not(ChosenLawsInLanes<Pack, kLanes>(lanes), numbers, parts);
  } else {
    f = one_wheel_closed_or_not(DefaultLaws{}, numbers, parts);
  }
  out = {f.pull.get(0), f.lateral.get(0), f.vertical.get(0), f.torque.get(0)};
}

void many_wheels(const WheelNumbers* wheels, const LawParts& parts, WheelForces* out, std::size_t count) {
  for (std::size_t first = 0; first < count; first += kLanes) {
    const std::size_t here = count - first < kLanes ? count - first : kLanes;
    std::array<const WheelNumbers*, kLanes> lanes;
    for (std::size_t lane = 0; lane < kLanes; ++lane) lanes[lane] = &wheels[first + (lane < here ? lane : 0)];
    const LaneForces<Pack> f = parts.chosen_laws
                                   ? lanes_closed_or_not(ChosenLawsInLanes<Pack, kLanes>(lanes), lanes, parts)
                                   : lanes_closed_or_not(DefaultLaws{}, lanes, parts);
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
