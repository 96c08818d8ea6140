#include "gap/diagnosis/model/channel_rows.h"

#include <Eigen/Core>
#include <cmath>
#include <numbers>

#include "core/quantile.h"
#include "gap/diagnosis/model/noise_model.h"
#include "gap/diagnosis/model/station_prediction.h"
#include "gap/diagnosis/model/window_readings.h"

namespace slipway::gap {
namespace {

constexpr double kDegPerRad = 180.0 / std::numbers::pi;
constexpr double kMmPerM = 1e3;

template <std::optional<Measured> WindowReadings::Motion::*member>
std::optional<Measured> motion(const WindowReadings& readings, std::size_t /*wheel*/) {
  return readings.motion().*member;
}

double predicted_slip(const StationPrediction& at, std::size_t /*wheel*/) {
  return at.state != nullptr ? sim::measured_slip(*at.state, at.command) : 1.0;
}

double predicted_side_slip(const StationPrediction& at, std::size_t /*wheel*/) {
  if (at.command.turn_in_place) return 0.0;
  const Eigen::Vector2d travel = sim::travel_direction(at.command);
  return (travel.x() * at.state->leftward_m_s - travel.y() * at.state->forward_m_s) /
         std::abs(at.command.speed_m_s);
}

double predicted_yaw_rate(const StationPrediction& at, std::size_t /*wheel*/) {
  if (at.command.turn_in_place) return at.state->yaw_rate_rad_s;
  return at.state->yaw_rate_rad_s - at.command.speed_m_s * at.command.curvature_1_m;
}

// A total that was recorded is compared as a mean, since the wheels of a rover on a slope do not share alike.
std::optional<Measured> current(const WindowReadings& readings, std::size_t wheel) {
  const bool together = readings.options().currents_split_evenly;
  if (together && wheel > 0) return std::nullopt;
  Readings of_wheel = readings.of_wheel(wheel, &WheelReading::current_a, readings.sense_of_current(wheel));
  if (of_wheel.count() == 0) return std::nullopt;
  const MeasurementStd& std = readings.measurement_std();
  const auto scatter = [&](double current_a) {
    return std::hypot(std.current_a, std.current_relative * current_a);
  };
  of_wheel = of_wheel.kept(2.0 * scatter(median(of_wheel.value)), readings.options());
  return Measured{of_wheel.mean(), scatter(of_wheel.mean()) / std::sqrt(of_wheel.count()), together};
}

double predicted_current(const StationPrediction& at, std::size_t wheel) {
  const sim::WheelState& state = at.state->wheels[wheel];
  return state.current_a * (state.rate_rad_s < 0.0 ? -1.0 : 1.0);
}

std::optional<Measured> sinkage(const WindowReadings& readings, std::size_t wheel) {
  const Readings of_wheel = readings.of_wheel(wheel, &WheelReading::sinkage_m);
  if (of_wheel.count() == 0) return std::nullopt;
  return Measured{of_wheel.mean(), readings.measurement_std().sinkage_m / std::sqrt(of_wheel.count())};
}

double predicted_sinkage(const StationPrediction& at, std::size_t wheel) {
  const sim::WheelState& state = at.state->wheels[wheel];
  const double below_track = at.rover.wheels[wheel].radius_m * (1.0 - std::cos(state.entry_angle_rad));
  return (1.0 - at.track_left_out) * state.sinkage_m + at.track_left_out * below_track;
}

}  // namespace

constexpr ChannelRow kSlipChannel{.name = "slip",
                                  .unit = "1",
                                  .chart_unit = "1",
                                  .observe = &motion<&WindowReadings::Motion::slip>,
                                  .predict = &predicted_slip,
                                  .predicted_when_stuck = true,
                                  .left_over = [](const NoiseScales& scales, double) { return scales.slip; },
                                  .located = true};

constexpr ChannelRow kSideSlipChannel{
    .name = "side_slip",
    .unit = "1",
    .chart_unit = "1",
    .observe = &motion<&WindowReadings::Motion::side_slip>,
    .predict = &predicted_side_slip,
    .left_over = [](const NoiseScales& scales, double) { return scales.side_slip; },
    .located = true};

constexpr ChannelRow kYawRateChannel{
    .name = "yaw_rate",
    .unit = "deg/s",
    .boundary_unit = kDegPerRad,
    .chart_unit = "deg/s",
    .chart_scale = kDegPerRad,
    .observe = &motion<&WindowReadings::Motion::yaw_rate>,
    .predict = &predicted_yaw_rate,
    .left_over = [](const NoiseScales& scales, double) { return scales.yaw_rate_rad_s; }};

constexpr ChannelRow kRollChannel{
    .name = "roll",
    .unit = "deg",
    .boundary_unit = kDegPerRad,
    .chart_unit = "deg",
    .chart_scale = kDegPerRad,
    .observe = &motion<&WindowReadings::Motion::roll>,
    .predict = [](const StationPrediction& at, std::size_t) { return at.attitude().roll_rad; },
    .predicted_when_stuck = true,
    .left_over = [](const NoiseScales& scales, double) { return scales.attitude_rad; },
    .of_the_stance = true};

constexpr ChannelRow kPitchChannel{
    .name = "pitch",
    .unit = "deg",
    .boundary_unit = kDegPerRad,
    .chart_unit = "deg",
    .chart_scale = kDegPerRad,
    .observe = &motion<&WindowReadings::Motion::pitch>,
    .predict = [](const StationPrediction& at, std::size_t) { return at.attitude().pitch_rad; },
    .predicted_when_stuck = true,
    .left_over = [](const NoiseScales& scales, double) { return scales.attitude_rad; },
    .of_the_stance = true};

constexpr ChannelRow kCurrentChannel{
    .name = "current",
    .unit = "A",
    .chart_unit = "A",
    .per_wheel = true,
    .column = {"current_a", -1000.0, 1000.0,
               [](DriveSample& s, std::size_t k, double v) { s.wheels[k].current_a = v; }},
    .observe = &current,
    .predict = &predicted_current,
    .left_over = [](const NoiseScales& scales,
                    double expected) { return scales.current_share * std::abs(expected); },
    .located = true};

constexpr ChannelRow kSinkageChannel{
    .name = "sinkage",
    .unit = "m",
    .chart_unit = "mm",
    .chart_scale = kMmPerM,
    .per_wheel = true,
    .column = {"sinkage_m", -2.0, 2.0,
               [](DriveSample& s, std::size_t k, double v) { s.wheels[k].sinkage_m = v; }},
    .observe = &sinkage,
    .predict = &predicted_sinkage,
    .left_over = [](const NoiseScales& scales, double) { return scales.sinkage_m; },
    .located = true};

}  // namespace slipway::gap
