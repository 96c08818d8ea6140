#include "planner/timing/motor_warmth.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace slipway::planner {

FollowingAir::FollowingAir(const Departure& departure, double time_constant_s)
    : mean_c_(0.5 * (departure.air->warmest_c + departure.air->coldest_c)),
      swing_k_(0.5 * (departure.air->warmest_c - departure.air->coldest_c)),
      rad_per_ms_(2.0 * std::numbers::pi / (1000.0 * departure.day_s)),
      lag_rad_(std::atan(1000.0 * rad_per_ms_ * time_constant_s)),
      noon_ms_(departure.noon_ms) {
  constexpr double kWarmest_rad = 2.0 * std::numbers::pi / 12.0;  // of the day behind noon
  swing_k_ *= std::cos(lag_rad_);
  lag_rad_ += kWarmest_rad;
}

double FollowingAir::at_c(std::int64_t utc_ms) const {
  return mean_c_ + swing_k_ * std::cos(rad_per_ms_ * static_cast<double>(utc_ms - noon_ms_) - lag_rad_);
}

MotorLosses motor_losses(const sim::RoverModel& rover, const sim::StationState& state) {
  MotorLosses losses;
  bool is_first = true;
  if (state.by_slip_curve) return losses;
  for (std::size_t k = 0; k < state.wheels.size(); ++k) {
    if (rover.wheels[k].drive != sim::WheelDrive::kDriven) continue;
    const sim::WheelState& wheel = state.wheels[k];
    const double torque_nm = wheel.torque_nm + std::copysign(rover.wheels[k].drag_nm, wheel.rate_rad_s);
    const double electric_w = sim::motor_state(rover.drive, torque_nm, wheel.rate_rad_s).electric_power_w;
    const double lost_w = std::max(0.0, electric_w - torque_nm * wheel.rate_rad_s);
    losses.most_w = std::max(losses.most_w, lost_w);
    losses.least_w = is_first ? lost_w : std::min(losses.least_w, lost_w);
    is_first = false;
  }
  return losses;
}

double MotorWarmth::after(double over_k, double losses_w, double seconds) const {
  const double settled_k = resistance_k_w * losses_w;
  return settled_k + (over_k - settled_k) * std::exp(-seconds / time_constant_s);
}

std::optional<MotorWarmth> motor_warmth(const sim::DriveMotor& drive) {
  if (!drive.thermal_resistance_k_w || !drive.thermal_time_constant_s) return std::nullopt;
  return MotorWarmth{*drive.thermal_resistance_k_w, *drive.thermal_time_constant_s};
}

}  // namespace slipway::planner
