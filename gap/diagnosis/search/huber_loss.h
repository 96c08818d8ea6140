#pragma once

#include <cmath>

namespace slipway::gap {

// Huber's loss of a residual in deviations: quadratic up to the threshold, linear beyond [Huber 1964, The
// Annals of Mathematical Statistics 35]. As a negative log density it has the normal's centre and tails as
// heavy as the exponential's.
struct HuberLoss {
  double threshold = 4.0;  // deviations

  double operator()(double residual) const {
    const double a = std::abs(residual);
    return a <= threshold ? 0.5 * a * a : threshold * (a - 0.5 * threshold);
  }
  // The weight of a least-squares row with the loss's slope: loss' (r) / r.
  double weight(double residual) const {
    return std::abs(residual) > threshold ? threshold / std::abs(residual) : 1.0;
  }
};

}  // namespace slipway::gap
