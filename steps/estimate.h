#pragma once

namespace slipway::steps {

// A figure with its 90 % interval.
struct Estimate {
  double value = 0.0, low = 0.0, high = 0.0;
};

}  // namespace slipway::steps
