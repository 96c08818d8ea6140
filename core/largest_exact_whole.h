#pragma once

#include <cstdint>

namespace slipway {

// 2^53 - 1: the last whole number that a number of JSON, a double, tells from its neighbours.
inline constexpr std::uint64_t kMaxExactWhole = 9'007'199'254'740'991;

}  // namespace slipway
