#pragma once

#include <cstddef>

namespace slipway::sim {

// For each of `count` numbers (a multiple of 8, aligned to 64 bytes), so many exponentials and logarithms of
// packs, summed into y: what the machine can do at best with the library that the wheel's law is written
// with. One for each instruction set of wheel_kernel.h.
using PackedExponentials = void(const double* x, double* y, std::size_t count, int exps, int logs);
PackedExponentials packed_exponentials_sse2, packed_exponentials_avx2, packed_exponentials_avx512;

}  // namespace slipway::sim
