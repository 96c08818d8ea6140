#pragma once

#include "core/normal_interval.h"

namespace slipway::gap {

// A number with a 90 % interval.
struct Interval {
  double value = 0.0, low = 0.0, high = 0.0;
};

// Of a normal estimate with this standard error.
inline Interval normal_interval(double value, double error) {
  return {value, value - kReach90 * error, value + kReach90 * error};
}

}  // namespace slipway::gap
