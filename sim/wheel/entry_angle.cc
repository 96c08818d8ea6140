#include "sim/wheel/entry_angle.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "sim/wheel/wheel_kernel.h"

namespace slipway::sim {

double power_stiffness(const WheelGeometry& wheel, const Soil& soil) {
  if (soil.pressure_law.row == nullptr) return soil.pressure.stiffness(wheel.width_m);
  const PressureForm form = soil.pressure_form({.width_m = wheel.width_m, .radius_m = wheel.radius_m});
  return form.stiffness * std::pow(form.per_depth_1_m, soil.pressure.n);
}

double bekker_sinkage_m(const WheelGeometry& wheel, const Soil& soil, double load_n) {
  const double n = soil.pressure.n;
  const double stiffness = power_stiffness(wheel, soil) * wheel.width_m;
  return std::pow(3.0 * load_n / ((3.0 - n) * stiffness * std::sqrt(2.0 * wheel.radius_m)),
                  2.0 / (2.0 * n + 1.0));
}

namespace {

struct Bracket {
  double low = 0.0, high = kMaxEntryAngleRad;
};

// Where the load carried first rises past the load, on a grid of entry angles evaluated at once. Errors:
// not_converged, with the greatest load carried and where.
Result<Bracket> first_bearing(const WheelGeometry& wheel, const Soil& soil, double load_n,
                              const WheelMotion& motion) {
  constexpr std::size_t kAngles = 64;
  std::array<WheelNumbers, kAngles> numbers;
  std::array<WheelForces, kAngles> forces;
  const auto angle = [deepest = max_entry_angle_rad(soil)](std::size_t k) {
    return deepest * static_cast<double>(k + 1) / static_cast<double>(kAngles);
  };
  for (std::size_t k = 0; k < kAngles; ++k) numbers[k] = numbers_of(wheel, soil, angle(k), motion);
  wheel_forces(numbers, forces);
  std::size_t best = 0;
  for (std::size_t k = 0; k < kAngles; ++k) {
    if (forces[k].vertical_n >= load_n) return Bracket{k == 0 ? 0.0 : angle(k - 1), angle(k)};
    if (forces[k].vertical_n > forces[best].vertical_n) best = k;
  }
  return fail(
      ErrorCode::kNotConverged,
      fmt::format("sunk to the axle: the soil carries at most {:.1f} N of {:.1f} N (at a depth of {:.0f} mm)",
                  std::max(0.0, forces[best].vertical_n), load_n,
                  1e3 * sinkage_m(wheel.radius_m, angle(best))));
}

}  // namespace

Result<double> balanced_entry_angle_rad(const WheelGeometry& wheel, const Soil& soil, double load_n,
                                        const WheelMotion& motion) {
  const auto surplus = [&](double theta) {
    return wheel_forces(wheel, soil, theta, motion).vertical_n - load_n;
  };
  Bracket bracket{.high = max_entry_angle_rad(soil)};
  double theta =
      std::clamp(entry_angle_rad(wheel.radius_m, bekker_sinkage_m(wheel, soil, load_n)), 0.02, 1.2);
  // A crust, and a braked wheel whose greatest stress is far ahead, carry most somewhere above the axle. The
  // same holds for wheels that dig or plough.
  if (soil.crust.strength_pa > 0.0 || soil.has_closures() || surplus(bracket.high) < 0.0) {
    const Result<Bracket> found = first_bearing(wheel, soil, load_n, motion);
    if (!found) return fail(found.error());
    bracket = *found;
    theta = 0.5 * (bracket.low + bracket.high);
  }
  constexpr double kStep = 1e-6;
  for (int iteration = 0; iteration < 100; ++iteration) {
    const double residual = surplus(theta);
    if (std::abs(residual) <= 1e-12 * load_n) break;
    (residual > 0.0 ? bracket.high : bracket.low) = theta;
    const double slope = (surplus(theta + kStep) - residual) / kStep;
    const double newton = theta - residual / slope;
    const bool inside = slope > 0.0 && newton > bracket.low && newton < bracket.high;
    const double next = inside ? newton : 0.5 * (bracket.low + bracket.high);
    if (std::abs(next - theta) <= 1e-14) break;
    theta = next;
  }
  return theta;
}

}  // namespace slipway::sim
