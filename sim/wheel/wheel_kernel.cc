#include "sim/wheel/wheel_kernel.h"

namespace slipway::sim {

extern const WheelKernel kWheelKernelSse2, kWheelKernelAvx2, kWheelKernelAvx512;

void LawParts::include(const WheelNumbers& in) {
  lateral |= in.leftward != 0.0;
  independent |= in.leftward != 0.0 && in.coupling != 1.0;
  coupled |= in.leftward != 0.0 && in.coupling != 0.0;
  grousers |= in.grouser_height > 0.0 && in.grouser_count > 0.0;
  bulldozing |= in.bulldozing != 0.0;
  side_bulldozing |= in.leftward != 0.0 && in.side_bulldozing != 0.0;
  crust |= in.crust_strength != 0.0;
  hardpan |= in.hardpan_modulus != 0.0;
  closures |= in.closed;
  undirected |= in.closures.slip_directed != 1.0;
  chosen_laws |= in.laws.pressure != nullptr || in.laws.shear != nullptr;
}

int wheel_kernels(const WheelKernel** out, int capacity) {
  int count = 0;
  const auto add = [&](const WheelKernel& kernel) {
    if (count < capacity) out[count++] = &kernel;
  };
  add(kWheelKernelSse2);
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) add(kWheelKernelAvx2);
  if (__builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512dq") &&
      __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("fma"))
    add(kWheelKernelAvx512);
  return count;
}

const WheelKernel& wheel_kernel() {
  static const WheelKernel& fastest = []() -> const WheelKernel& {
    const WheelKernel* all[3];
    return *all[wheel_kernels(all, 3) - 1];
  }();
  return fastest;
}

}  // namespace slipway::sim
