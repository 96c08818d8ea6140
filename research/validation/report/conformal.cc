#include "research/validation/report/conformal.h"

#include <algorithm>
#include <cmath>

namespace slipway::validation {

double stretch_to_hold(double low, double high, double value) {
  const double half = 0.5 * (high - low);
  return std::abs(value - (low + half)) / half;
}

std::optional<double> conformal_stretch(std::vector<double> stretches, double level) {
  const double rank = std::ceil((static_cast<double>(stretches.size()) + 1.0) * level - 1e-9);
  if (rank > static_cast<double>(stretches.size())) return std::nullopt;
  std::sort(stretches.begin(), stretches.end());
  return stretches[static_cast<std::size_t>(rank) - 1];
}

}  // namespace slipway::validation
