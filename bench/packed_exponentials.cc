// Compiled once for each instruction set.
#include "bench/packed_exponentials.h"

#include <xsimd/xsimd.hpp>

namespace slipway::sim {

void SLIPWAY_PACKED_NAME(const double* x, double* y, std::size_t count, int exps, int logs) {
  using Pack = xsimd::batch<double, SLIPWAY_PACKED_ARCH>;
  for (std::size_t k = 0; k < count; k += Pack::size) {
    const Pack in = Pack::load_aligned(x + k);
    Pack sum(0.0);
    for (int i = 0; i < exps; ++i) sum += exp(-in * Pack(0.1 * i));
    for (int i = 0; i < logs; ++i) sum += log(in * Pack(1.0 + i));
    sum.store_aligned(y + k);
  }
}

}  // namespace slipway::sim
