#pragma once

#include <vector>

namespace slipway {

// The value below which a share of the values lies, linear between order statistics (Hyndman and Fan's type
// 7). There must be at least one value, and share must be in [0, 1].
double quantile(std::vector<double> values, double share);

// The middle value, or the mean of the middle two where their number is even. There must be at least one
// value; values may be infinite.
double median(std::vector<double> values);

}  // namespace slipway
