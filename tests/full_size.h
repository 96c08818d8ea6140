#pragma once

#include <cstdlib>

namespace slipway {

// Whether a test is to run at its full size: with `ctest -C full`, see tests/gtests.cmake.
inline bool full_size() {
  return std::getenv("SLIPWAY_FULL_SIZE") != nullptr;
}

}  // namespace slipway
