#include "tests/api/new_rows/wheel_rate_channel.h"

#include <cmath>
#include <numbers>

#include "core/angle.h"
#include "gap/diagnosis/model/station_prediction.h"
#include "gap/diagnosis/model/window_readings.h"

namespace slipway::gap {
namespace {

constexpr double kDegPerRad = 180.0 / std::numbers::pi;
constexpr double kEncoderStd = 1e-3;  // rad/s

std::optional<Measured> rate(const WindowReadings& readings, std::size_t wheel) {
  const Readings of_wheel = readings.of_wheel(wheel, &WheelReading::rate_rad_s);
  if (of_wheel.count() == 0) return std::nullopt;
  return Measured{of_wheel.mean(), kEncoderStd / std::sqrt(of_wheel.count())};
}

}  // namespace

constexpr ChannelRow kWheelRateChannel{
    .name = "wheel_rate",
    .unit = "deg/s",
    .boundary_unit = kDegPerRad,
    .chart_unit = "deg/s",
    .chart_scale = kDegPerRad,
    .per_wheel = true,
    .column = {"encoder_deg_s", -1e4, 1e4,
               [](DriveSample& s, std::size_t k, double v) { s.wheels[k].rate_rad_s = rad_from_deg(v); }},
    .observe = &rate,
    .predict = [](const StationPrediction& at,
                  std::size_t wheel) { return at.state->wheels[wheel].rate_rad_s; },
    .left_over = [](const NoiseScales&, double) { return 2e-3; }};

}  // namespace slipway::gap
