#pragma once

#include <cmath>
#include <numbers>

namespace slipway {

// The program computes in radians; requests, answers and files have degrees. Only these two functions
// convert.
constexpr double deg_from_rad(double rad) {
  return rad * (180.0 / std::numbers::pi);
}
constexpr double rad_from_deg(double deg) {
  return deg * (std::numbers::pi / 180.0);
}

// The same direction in (-pi, pi].
inline double wrapped_rad(double rad) {
  constexpr double kTurn = 2.0 * std::numbers::pi;
  const double size = std::abs(rad);
  // Within a turn and a half a subtraction is exact (Sterbenz 1974) and gives what std::remainder does, which
  // took a quarter of a search for routes.
  double r = rad;
  if (size >= 1.5 * kTurn || size == kTurn || std::isnan(rad))
    r = std::remainder(rad, kTurn);
  else if (size > 0.5 * kTurn)
    r = rad > 0.0 ? rad - kTurn : rad + kTurn;
  return r <= -std::numbers::pi ? std::numbers::pi : r;
}

}  // namespace slipway
