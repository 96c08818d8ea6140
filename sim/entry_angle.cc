#include "sim/entry_angle.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace slipway::sim {

double bekker_sinkage_m(const WheelGeometry& wheel, const Soil& soil, double load_n) {
  const double n = soil.pressure.n;
  const double stiffness = soil.pressure.stiffness(wheel.width_m) * wheel.width_m;
  return std::pow(3.0 * load_n / ((3.0 - n) * stiffness * std::sqrt(2.0 * wheel.radius_m)),
                  2.0 / (2.0 * n + 1.0));
}

Result<double> balanced_entry_angle_rad(const WheelGeometry& wheel, const Soil& soil, double load_n,
                                        const WheelMotion& motion) {
  const auto surplus = [&](double theta) {
    return wheel_forces(wheel, soil, theta, motion).vertical_n - load_n;
  };
  double low = 0.0, high = kLargestEntryAngleRad;
  const double most = surplus(high);
  if (most < 0.0) {
    return fail(
        ErrorCode::kNotConverged,
        fmt::format("sunk to the axle: the soil carries {:.1f} N of {:.1f} N", most + load_n, load_n));
  }
  double theta =
      std::clamp(entry_angle_rad(wheel.radius_m, bekker_sinkage_m(wheel, soil, load_n)), 0.02, 1.2);
  constexpr double kStep = 1e-6;
  for (int iteration = 0; iteration < 100; ++iteration) {
    const double residual = surplus(theta);
    if (std::abs(residual) <= 1e-12 * load_n) break;
    (residual > 0.0 ? high : low) = theta;
    const double slope = (surplus(theta + kStep) - residual) / kStep;
    const double newton = theta - residual / slope;
    const double next = slope > 0.0 && newton > low && newton < high ? newton : 0.5 * (low + high);
    if (std::abs(next - theta) <= 1e-14) break;
    theta = next;
  }
  return theta;
}

}  // namespace slipway::sim
