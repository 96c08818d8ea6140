#include "gap/diagnosis/model/smooth_difference.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/angle.h"
#include "gap/diagnosis/model/noise_model.h"
#include "gap/diagnosis/model/reference_belief.h"

namespace slipway::gap {
namespace {

constexpr std::size_t kFunctions = 20;
using Functions = std::array<double, kFunctions>;
// Of smooth_functions: those that are next to nothing on gentle ground.
constexpr std::array<bool, kFunctions> kIsHarsh{false, false, true,  true,  false, true, false,
                                                true,  false, true,  true,  false, true, false,
                                                false, false, false, false, false, false};

// What a circumstance is divided by, so that it is about 1 where drives are harsh.
constexpr double kSlope_deg = 10.0, kSlipScale = 0.2, kCurvature_1_m = 0.4, kTemperature_c = 30.0;
constexpr double kMaxSlip = 4.0, kMaxSpeed = 2.0;  // of these: beyond it the difference stays as it is
// A coefficient's unit, in what a channel's windows scatter by before any drive was seen.
constexpr double kUnit = 5.0;

double slip_of(const WindowModel& model, std::size_t w, std::span<const double> expected) {
  const DriveWindow& window = model.windows()[w];
  for (std::size_t i = 0; i < window.observations.size(); ++i)
    if (window.observations[i].channel == Channel::kSlip)
      if (const double slip = expected[model.offset(w) + i]; std::isfinite(slip)) return slip;
  return 0.0;
}

Functions smooth_functions(const WindowModel& model, std::size_t w, std::span<const double> expected) {
  const WindowModel::Conditions& at = model.conditions(w);
  const sim::DriveCommand& command = model.windows()[w].command;
  const double p = deg_from_rad(at.pitch_rad) / kSlope_deg, r = deg_from_rad(at.roll_rad) / kSlope_deg;
  const double warm = command.motor_temp_c ? *command.motor_temp_c / kTemperature_c : 0.0;
  Functions f{};
  if (command.turn_in_place) {
    f[16] = 1.0;
    f[17] = command.turn_rate_rad_s < 0.0 ? -1.0 : 1.0;
    f[18] = p;
    f[19] = r;
    return f;
  }
  const double s = std::clamp(slip_of(model, w, expected) / kSlipScale, -kMaxSlip, kMaxSlip);
  const double d = command.speed_m_s < 0.0 ? -1.0 : 1.0;
  const double v = std::clamp(std::abs(command.speed_m_s) / model.campaign().rover->cruise_speed_m_s - 1.0,
                              -1.0, kMaxSpeed);
  const double k = command.curvature_1_m / kCurvature_1_m;
  return {1.0,   p,     p * p, p * p * p / 2.0, r, r * r,       s,   s * s, d,
          d * p, d * r, v,     v * p,           k, std::abs(k), warm};
}

std::size_t copies_of(const ChannelRow& row, const sim::RoverModel& rover) {
  return row.per_wheel ? rover.wheels.size() : 1;
}

}  // namespace

SmoothScale smooth_scale(const WindowModel& model, std::span<const double> expected) {
  const std::size_t channels = channel_count();
  std::vector<double> squares(channels, 0.0), count(channels, 0.0);
  std::size_t row = 0;
  for (const DriveWindow& window : model.windows())
    for (const Observation& o : window.observations) {
      const auto c = static_cast<std::size_t>(o.channel);
      const double value = expected[row++];
      if (!std::isfinite(value)) continue;
      squares[c] += value * value;
      count[c] += 1.0;
    }
  SmoothScale scale;
  for (std::size_t c = 0; c < channels; ++c) {
    const double usual = count[c] > 0.0 ? std::sqrt(squares[c] / count[c]) : 0.0;
    scale.unit.push_back(kUnit * row_of(static_cast<Channel>(c)).left_over({}, usual));
  }
  return scale;
}

Eigen::MatrixXd smooth_columns(const WindowModel& model, std::span<const double> expected,
                               const SmoothScale& scale) {
  std::vector<std::size_t> first{0};
  for (const ChannelRow& row : channel_catalogue())
    first.push_back(first.back() + kFunctions * copies_of(row, *model.campaign().rover));
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(model.observation_count()),
                                                  static_cast<Eigen::Index>(first.back()));
  for (std::size_t w = 0; w < model.windows().size(); ++w) {
    if (!model.used(w)) continue;
    const Functions f = smooth_functions(model, w, expected);
    for (std::size_t i = 0; i < model.windows()[w].observations.size(); ++i) {
      const Observation& o = model.windows()[w].observations[i];
      const auto c = static_cast<std::size_t>(o.channel);
      const std::size_t of_wheel = kFunctions * static_cast<std::size_t>(std::max(0, o.wheel));
      for (std::size_t k = 0; k < kFunctions; ++k)
        columns(static_cast<Eigen::Index>(model.offset(w) + i),
                static_cast<Eigen::Index>(first[c] + of_wheel + k)) = scale.unit[c] * f[k];
    }
  }
  return columns;
}

std::vector<std::size_t> smooth_groups(const sim::RoverModel& rover) {
  std::vector<std::size_t> groups;
  for (std::size_t c = 0; c < channel_count(); ++c)
    for (std::size_t copy = 0; copy < copies_of(channel_catalogue()[c], rover); ++copy)
      for (std::size_t k = 0; k < kFunctions; ++k)
        groups.push_back(kSmoothGroups * c + (kIsHarsh[k] ? 1 : 0));
  return groups;
}

std::size_t place_in(std::span<const std::string> names, const std::string& name) {
  return static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
}

}  // namespace slipway::gap
