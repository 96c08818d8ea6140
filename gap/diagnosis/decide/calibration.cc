#include "gap/diagnosis/decide/calibration.h"

#include <algorithm>
#include <cmath>

namespace slipway::gap {

double Calibration::operator()(double marginal, double share) const {
  if (!(share > 0.0)) return 0.0;
  // Beyond these neither number says more: no simulator is exact.
  constexpr double kLeastProbability = 0.01, kLeastShare = 0.01;
  const double p = std::clamp(marginal, kLeastProbability, 1.0 - kLeastProbability);
  return 1.0 / (1.0 + std::exp(-constant - by_log_odds * std::log(p / (1.0 - p)) -
                               by_log_share * std::log(std::max(share, kLeastShare))));
}

const Calibration& calibration(bool with_reference) {
  static constexpr Calibration kWithout{0.898, 1.151, 0.523}, kWith{1.368, 0.733, 1.686};
  return with_reference ? kWith : kWithout;
}

}  // namespace slipway::gap
