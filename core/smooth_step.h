#pragma once

#include <algorithm>

namespace slipway {

// 0 up to x = 0, 1 from x = 1 on, and x^2 (3 - 2 x) between, which is continuous with its first derivative.
inline double smooth_step(double x) {
  const double c = std::clamp(x, 0.0, 1.0);
  return c * c * (3.0 - 2.0 * c);
}

}  // namespace slipway
