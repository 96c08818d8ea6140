#include "sim/wheel/free_wheel.h"

#include <cmath>
#include <limits>

namespace slipway::sim {

FreeRolling roll_freely(const WheelGeometry& wheel, const Soil& soil, double entry_angle_rad,
                        const WheelMotion& over_ground, double drag_nm, double slowest_ratio) {
  const auto at_ratio = [&](double rho) {
    FreeRolling rolling;
    rolling.rim_ratio = rho;
    rolling.motion = {.forward = over_ground.forward / rho, .leftward = over_ground.leftward / rho};
    rolling.forces = wheel_forces(wheel, soil, entry_angle_rad, rolling.motion);
    return rolling;
  };
  const auto surplus = [drag_nm](const FreeRolling& rolling) { return rolling.forces.torque_nm + drag_nm; };

  FreeRolling low = at_ratio(slowest_ratio);
  if (over_ground.forward <= slowest_ratio || surplus(low) >= 0.0) return low;
  FreeRolling high = at_ratio(over_ground.forward);
  // With resistances that brake the rim itself (grousers, side walls) the wheel could need a little more.
  for (int widening = 0; widening < 10 && surplus(high) < 0.0; ++widening)
    high = at_ratio(1.3 * high.rim_ratio);
  if (surplus(high) < 0.0) return high;

  // Regula falsi with the Illinois halving of the end that stays [Dowell & Jarratt 1971].
  double at_low = surplus(low), at_high = surplus(high);
  int stayed = 0;
  // Far below what differences over a wheel's arguments see.
  const double tolerance_nm = 1e-14 * std::abs(at_low);
  const double width = 4.0 * std::numeric_limits<double>::epsilon() * high.rim_ratio;
  for (int iteration = 0; iteration < 80 && high.rim_ratio - low.rim_ratio > width; ++iteration) {
    const double span = high.rim_ratio - low.rim_ratio;
    const FreeRolling next = at_ratio(low.rim_ratio - at_low * span / (at_high - at_low));
    const double there = surplus(next);
    if (std::abs(there) <= tolerance_nm) return next;
    if (there < 0.0) {
      low = next;
      at_low = there;
      if (stayed == -1) at_high *= 0.5;
      stayed = -1;
    } else {
      high = next;
      at_high = there;
      if (stayed == 1) at_low *= 0.5;
      stayed = 1;
    }
  }
  return std::abs(surplus(low)) < std::abs(surplus(high)) ? low : high;
}

}  // namespace slipway::sim
