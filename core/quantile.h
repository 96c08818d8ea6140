#pragma once

#include <vector>

namespace slipway {

// The value below which a share of the values lies, linear between order statistics (Hyndman and Fan's type
// 7). Values not empty, share in [0, 1].
double quantile(std::vector<double> values, double share);

// The middle value, of an even number the mean of the middle two. Values not empty; they may be infinite.
double median(std::vector<double> values);

}  // namespace slipway
