#pragma once

#include <array>
#include <cstddef>

#include "sim/soil/hyperbolic_shear.h"
#include "sim/wheel/wheel_law.h"

namespace slipway::sim {

// The laws that the soils under a pack's wheels choose, each lane by its own. A law that is a power of depth,
// or has the kernel's form of shear, is computed in packs; any other lane by lane from the law's own
// function.
template <class V, std::size_t kLanes>
class ChosenLawsInLanes {
 public:
  // One wheel for each lane; the same one in all of them where a pack holds nodes of one wheel.
  explicit ChosenLawsInLanes(const std::array<const WheelNumbers*, kLanes>& wheels) : wheels_(wheels) {
    alignas(64) double per_depth[kLanes], end[kLanes], hump[kLanes], hyperbola[kLanes];
    for (std::size_t k = 0; k < kLanes; ++k) {
      const ChosenLaws& laws = wheels[k]->laws;
      per_depth[k] = laws.per_depth;
      end[k] = laws.shear_form.end;
      hump[k] = laws.shear_form.hump;
      hyperbola[k] = laws.shear_form.hyperbola;
      any_hyperbola_ |= hyperbola[k] != 0.0;
      all_hyperbola_ &= hyperbola[k] == 1.0 && !has_own_shear(laws);
      own_pressure_ |= has_own_pressure(laws);
      own_shear_ |= has_own_shear(laws);
    }
    per_depth_ = V::load_aligned(per_depth);
    end_ = V::load_aligned(end);
    hump_ = V::load_aligned(hump);
    hyperbola_ = V::load_aligned(hyperbola);
  }

  V pressure_pa(const WheelValues<V>& in, const V& n, const V& depth_m) const {
    const V power = bekker_pressure_pa(in.stiffness, n, depth_m * per_depth_);
    if (!own_pressure_) return power;
    alignas(64) double p[kLanes], z[kLanes], exponent[kLanes], factor[kLanes];
    power.store_aligned(p);
    depth_m.store_aligned(z);
    n.store_aligned(exponent);
    in.stiffness.store_aligned(factor);
    for (std::size_t k = 0; k < kLanes; ++k) {
      const ChosenLaws& laws = wheels_[k]->laws;
      if (has_own_pressure(laws))
        p[k] = factor[k] * laws.pressure->pressure_pa(laws.pressure_numbers, exponent[k], z[k]);
    }
    return V::load_aligned(p);
  }

  V mobilised(const V& displacement_over_modulus) const {
    if (all_hyperbola_) return hyperbolic_mobilised(displacement_over_modulus);
    const V left = exp(-displacement_over_modulus);
    V form = (end_ + hump_ * left) * (V(1.0) - left);
    if (any_hyperbola_) form += hyperbola_ * (hyperbolic_mobilised(displacement_over_modulus) - form);
    if (!own_shear_) return form;
    alignas(64) double m[kLanes], x[kLanes];
    form.store_aligned(m);
    displacement_over_modulus.store_aligned(x);
    for (std::size_t k = 0; k < kLanes; ++k) {
      const ChosenLaws& laws = wheels_[k]->laws;
      if (has_own_shear(laws)) m[k] = laws.shear->mobilised(laws.shear_parameters, x[k]);
    }
    return V::load_aligned(m);
  }

 private:
  static bool has_own_pressure(const ChosenLaws& laws) {
    return laws.pressure != nullptr && laws.pressure->pressure_pa != nullptr;
  }
  static bool has_own_shear(const ChosenLaws& laws) {
    return laws.shear != nullptr && laws.shear->mobilised != nullptr;
  }

  std::array<const WheelNumbers*, kLanes> wheels_;
  V per_depth_, end_, hump_, hyperbola_;
  bool any_hyperbola_ = false, all_hyperbola_ = true;
  bool own_pressure_ = false, own_shear_ = false;
};

}  // namespace slipway::sim
