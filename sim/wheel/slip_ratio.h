#pragma once

#include <algorithm>

namespace slipway::sim {

// Slip (driving, positive) and skid (braking, negative) of a wheel, [ARTEMIS eq. 21]:
//
//   i = 1 - v / (r w)    where v < r w        i = (r w) / v - 1    where v > r w
//
// Here u = v / (r w), the wheel centre's speed over the rim's: u = 1 rolls freely, u = 0 spins on the spot, u
// -> inf is a locked wheel. Both branches and their slopes meet at u = 1. A rover that slides back against
// its spinning wheels has u < 0 and i > 1; reports bound i to [-1, 1].
inline double slip_from_speed_ratio(double u) {
  return u <= 1.0 ? 1.0 - u : 1.0 / u - 1.0;
}

inline double speed_ratio_from_slip(double i) {
  return i >= 0.0 ? 1.0 - i : 1.0 / (1.0 + i);
}

inline double bounded_slip(double i) {
  return std::clamp(i, -1.0, 1.0);
}

}  // namespace slipway::sim
