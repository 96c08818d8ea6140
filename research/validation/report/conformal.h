#pragma once

#include <optional>
#include <vector>

namespace slipway::validation {

// By how much of its half width an interval must be stretched about its middle to hold the value: 1 where the
// value is on its end, less where the value is inside. The interval must have a width.
double stretch_to_hold(double low, double high, double value);

// The least of the stretches that, by exchangeability, holds a next one with at least the probability
// `level`: the ceil((n + 1) level)-th smallest of n [Vovk et al. 2005; Romano, Patterson and Candes 2019].
// Empty where there are too few for that level, nine for 0.9.
std::optional<double> conformal_stretch(std::vector<double> stretches, double level);

}  // namespace slipway::validation
