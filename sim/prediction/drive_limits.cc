#include "sim/prediction/drive_limits.h"

#include <fmt/format.h>

#include <array>
#include <string_view>

namespace slipway::sim {

std::string_view describe(Rule rule) {
  static constexpr std::array<std::string_view, kRules> kNames{"slip_check", "tilt",      "current",
                                                               "sinkage",    "clearance", "embedding"};
  return kNames[static_cast<std::size_t>(rule)];
}

std::vector<std::string> broken_limits(const DriveExtremes& extremes, const DriveLimits& limits) {
  std::vector<std::string> broken;
  const auto at_most = [&](std::string_view name, const Peak& peak, double limit, double scale,
                           std::string_view unit) {
    if (peak.value > limit)
      broken.push_back(fmt::format("{} {:.3g}{} at {:.1f} m, limit {:.3g}{}", name, peak.value * scale, unit,
                                   peak.distance_m, limit * scale, unit));
  };
  at_most("slip", extremes.max_slip_ratio, limits.max_slip_ratio, 1.0, "");
  at_most("tilt", extremes.max_tilt_rad, limits.max_tilt_rad, deg_from_rad(1.0), " deg");
  at_most("current", extremes.max_current_a, limits.max_current_a, 1.0, " A");
  at_most("sinkage", extremes.max_sinkage_m, limits.max_sinkage_m, 1.0, " m");
  if (const auto& least = extremes.least_clearance_m; least && least->value < limits.min_clearance_m)
    broken.push_back(fmt::format("clearance {:.3g} m at {:.1f} m, limit {:.3g} m", least->value,
                                 least->distance_m, limits.min_clearance_m));
  return broken;
}

}  // namespace slipway::sim
