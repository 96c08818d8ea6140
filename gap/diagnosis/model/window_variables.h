#pragma once

#include <string_view>

namespace slipway::gap {

// What a gap may depend on, of one window.
struct WindowVariables {
  double slope_deg = 0.0;        // along the travel, positive uphill
  double cross_slope_deg = 0.0;  // positive: left side up
  double slip = 0.0;             // measured
  double speed_m_s = 0.0;        // commanded, negative backwards
  double curvature_1_m = 0.0;
  double temperature_c = 0.0;
  double turning = 0.0;
  double time_s = 0.0;  // since the drive began
};
// The same, in that order.
enum class WindowVariable { kSlope, kCrossSlope, kSlip, kSpeed, kCurvature, kTemperature, kTurning, kTime };
constexpr int kWindowVariables = 8;
std::string_view name_of(WindowVariable variable);  // "slope_deg", ...
double variable_of(const WindowVariables& of, WindowVariable variable);

}  // namespace slipway::gap
