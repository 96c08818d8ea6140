#include "sim/quasi_static/slip_curve_motion.h"

#include <algorithm>
#include <cmath>

#include "sim/quasi_static/balance_search.h"
#include "sim/wheel/slip_ratio.h"

namespace slipway::sim {
namespace {

// No slip was measured turning in place: that on the level stands in for it.
SlipOnCurve slip_turning_in_place(const Soil& soil) {
  SlipOnCurve slip = slip_on_curve(soil, {});
  slip.side_slip_rad = 0.0;
  return slip;
}

SlipOnCurve most_slip(const PerWheel<Soil>& soils, const TravelSlopes& slopes, bool turn_in_place) {
  std::optional<SlipOnCurve> most;
  for (const Soil& soil : soils) {
    if (soil.slip_curve == nullptr) continue;
    const SlipOnCurve slip = turn_in_place ? slip_turning_in_place(soil) : slip_on_curve(soil, slopes);
    if (slip.outside) return slip;
    if (!most || std::abs(slip.slip_ratio) > std::abs(most->slip_ratio)) most = slip;
  }
  return most.value_or(SlipOnCurve{});
}

}  // namespace

TravelSlopes travel_slopes(const Eigen::Matrix3d& R_MB, const DriveCommand& command) {
  const Eigen::Vector2d d = travel_direction(command);
  const auto slope = [&](double x, double y) {
    return std::asin(std::clamp(R_MB(2, 0) * x + R_MB(2, 1) * y, -1.0, 1.0));
  };
  const double along = slope(d.x(), d.y());
  return {command.speed_m_s < 0.0 ? -along : along, slope(-d.y(), d.x())};
}

SlipOnCurve slip_on_curve(const Soil& soil, const TravelSlopes& slopes) {
  const std::optional<double> along = soil.slip_curve->slip_at(slopes.along_rad);
  const std::optional<double> side = soil.slip_curve->side_slip_at(slopes.across_rad);
  if (!along || !side) return {.slip_ratio = 1.0, .outside = true};
  // Downhill is to the right where the left side is up.
  return {.slip_ratio = std::clamp(*along + soil.slip_deviation, -1.0, 1.0), .side_slip_rad = -*side};
}

StationState motion_on_slip_curves(const RoverModel& rover, const Stance& stance, const PerWheel<Soil>& soils,
                                   const DriveCommand& command) {
  const SlipOnCurve slip = most_slip(soils, travel_slopes(stance.R_MB, command), command.turn_in_place);
  StationState state;
  state.by_slip_curve = true;
  state.attitude = stance.attitude;
  state.wheels = PerWheel<WheelState>(rover.wheels.size());
  state.slip_ratio = slip.slip_ratio;
  const double ratio = speed_ratio_from_slip(std::max(slip.slip_ratio, -0.99));
  if (slip.outside) {
    state.outcome = Outcome::kOutsideSlipCurve;
    return state;
  }
  if (ratio < kSpinningSpeedRatio) {
    state.outcome = Outcome::kNoTraction;
    state.slip_ratio = 1.0;
    return state;
  }
  const double share = attainable_share(rover, command);
  if (command.turn_in_place) {
    state.yaw_rate_rad_s = ratio * share * command.turn_rate_rad_s;
    return state;
  }
  const Eigen::Vector2d d = travel_direction(command);
  const double along = ratio * share * command.speed_m_s,
               across = std::tan(slip.side_slip_rad) * std::abs(along);
  state.along_m_s = along;
  state.forward_m_s = along * d.x() - across * d.y();
  state.leftward_m_s = along * d.y() + across * d.x();
  state.side_slip_rad = slip.side_slip_rad;
  // Of the arc that is commanded.
  state.yaw_rate_rad_s = along * command.curvature_1_m;
  return state;
}

}  // namespace slipway::sim
