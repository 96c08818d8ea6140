#pragma once

#include <vector>

namespace slipway {

// The value below which a share of the values lies, linear between order statistics (Hyndman and Fan's type
// 7). Values not empty, share in [0, 1].
double quantile(std::vector<double> values, double share);

}  // namespace slipway
