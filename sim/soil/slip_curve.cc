#include "sim/soil/slip_curve.h"

#include <algorithm>
#include <cmath>

namespace slipway::sim {
namespace {

std::optional<double> between(const std::vector<double>& at, const std::vector<double>& value, double place) {
  if (at.empty() || !(place >= at.front() && place <= at.back())) return std::nullopt;
  const auto after = std::upper_bound(at.begin(), at.end(), place);
  if (after == at.end()) return value.back();
  const auto k = static_cast<std::size_t>(after - at.begin());
  const double share = (place - at[k - 1]) / (at[k] - at[k - 1]);
  return value[k - 1] + share * (value[k] - value[k - 1]);
}

bool rises(const std::vector<double>& values) {
  return std::adjacent_find(values.begin(), values.end(), std::greater_equal<>()) == values.end();
}

}  // namespace

std::optional<double> SlipCurve::slip_at(double slope) const {
  return between(slope_rad, slip_ratio, slope);
}

std::optional<double> SlipCurve::side_slip_at(double cross_slope) const {
  const std::optional<double> side = between(cross_slope_rad, side_slip_rad, std::abs(cross_slope));
  return side ? std::optional(std::copysign(*side, cross_slope)) : std::nullopt;
}

std::vector<Fault> faults_of(const SlipCurve& curve) {
  std::vector<Fault> faults;
  const auto fault = [&](const char* column, const char* message) {
    faults.push_back({std::string("/slip_curve/") + column, message});
  };
  if (curve.slip_ratio.size() != curve.slope_rad.size())
    fault("slip", "slip and slope_deg must have as many values");
  if (curve.side_slip_rad.size() != curve.cross_slope_rad.size())
    fault("side_slip_deg", "side_slip_deg and cross_slope_deg must have as many values");
  if (!rises(curve.slope_rad)) fault("slope_deg", "slope_deg must rise from value to value");
  if (!rises(curve.cross_slope_rad))
    fault("cross_slope_deg", "cross_slope_deg must rise from value to value");
  if (curve.slope_rad.empty() || curve.slope_rad.front() > 0.0 || curve.slope_rad.back() < 0.0)
    fault("slope_deg", "slope_deg must span the level, 0 deg");
  if (curve.cross_slope_rad.empty() || curve.cross_slope_rad.front() != 0.0)
    fault("cross_slope_deg", "cross_slope_deg must begin at 0 deg");
  if (curve.side_slip_rad.empty() || curve.side_slip_rad.front() != 0.0)
    fault("side_slip_deg", "side_slip_deg must begin at 0 deg, by symmetry");
  return faults;
}

}  // namespace slipway::sim
