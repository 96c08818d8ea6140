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
  const double r = std::remainder(rad, 2.0 * std::numbers::pi);
  return r <= -std::numbers::pi ? std::numbers::pi : r;
}

}  // namespace slipway
