#include "gap/diagnosis/model/smooth_difference.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

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
// Beyond what a reference met, for each unit of a circumstance: in units of a coefficient. It is what another
// simulator may be off by: half of a current, 0.2 of slip for each 10 deg.
constexpr double kBeyond = 10.0;
// How steep it is there may change after so much of a circumstance, and after as much again: what was learnt
// of 10 deg says little of 15.
constexpr double kSegment = 0.5;
// Of a kind of drives that a reference has none of even a level one lies so far beyond it.
constexpr double kUnmet = 1.0;
constexpr std::size_t kSegments = 3;
constexpr std::size_t kBeyondFunctions = 2 * kRanged * kSegments;

double slip_of(const WindowModel& model, std::size_t w, std::span<const double> expected) {
  const DriveWindow& window = model.windows()[w];
  for (std::size_t i = 0; i < window.observations.size(); ++i)
    if (window.observations[i].channel == Channel::kSlip)
      if (const double slip = expected[model.offset(w) + i]; std::isfinite(slip)) return slip;
  return 0.0;
}

// What a window met, each about 1 where drives are harsh.
struct Met {
  bool turning = false;
  double turn = 0.0;  // in place: 1 to the left, -1 to the right
  double p = 0.0, r = 0.0, s = 0.0, d = 0.0, v = 0.0, k = 0.0, warm = 0.0;
};

Met met_by(const WindowModel& model, std::size_t w, std::span<const double> expected) {
  const WindowModel::Conditions& at = model.conditions(w);
  const sim::DriveCommand& command = model.windows()[w].command;
  Met met{.turning = command.turn_in_place,
          .p = deg_from_rad(at.pitch_rad) / kSlope_deg,
          .r = deg_from_rad(at.roll_rad) / kSlope_deg};
  if (met.turning) {
    met.turn = command.turn_rate_rad_s < 0.0 ? -1.0 : 1.0;
    return met;
  }
  met.s = std::clamp(slip_of(model, w, expected) / kSlipScale, -kMaxSlip, kMaxSlip);
  met.d = command.speed_m_s < 0.0 ? -1.0 : 1.0;
  met.v = std::clamp(std::abs(command.speed_m_s) / model.campaign().rover->cruise_speed_m_s - 1.0, -1.0,
                     kMaxSpeed);
  met.k = command.curvature_1_m / kCurvature_1_m;
  met.warm = command.motor_temp_c ? *command.motor_temp_c / kTemperature_c : 0.0;
  return met;
}

Functions smooth_functions(const Met& at) {
  const auto& [turning, turn, p, r, s, d, v, k, warm] = at;
  Functions f{};
  if (turning) {
    f[16] = 1.0;
    f[17] = turn;
    f[18] = p;
    f[19] = r;
    return f;
  }
  return {1.0,   p,     p * p, p * p * p / 2.0, r, r * r,       s,   s * s, d,
          d * p, d * r, v,     v * p,           k, std::abs(k), warm};
}

// The ranged circumstances that every window of a kind has: drives forward, drives backward, turns in place.
constexpr std::array<std::size_t, 3> kFirstOfKind{0, 3, 7};

// What a range is of: of drives forward, of drives backward and of turns in place apart, and of speed and
// curvature of both. NaN where a window says nothing of it.
std::array<double, kRanged> ranged(const Met& at) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  std::array<double, kRanged> of;
  of.fill(kNone);
  if (at.turning) {
    of[7] = std::hypot(at.p, at.r);  // at the headings between up and across too
    of[8] = at.p;
    of[9] = at.r;
    of[10] = at.turn;
    return of;
  }
  const std::size_t first = at.d < 0.0 ? 3 : 0;
  of[first] = at.p;
  of[first + 1] = at.r;
  of[first + 2] = at.s;
  of[6] = at.warm;
  of[11] = at.v;
  of[12] = at.k;
  return of;
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
    const Functions f = smooth_functions(met_by(model, w, expected));
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

SmoothRange smooth_range(const WindowModel& model, std::span<const double> expected) {
  SmoothRange range;
  std::array<bool, kRanged>& seen = range.seen;
  for (std::size_t w = 0; w < model.windows().size(); ++w) {
    if (!model.used(w)) continue;
    const std::array<double, kRanged> value = ranged(met_by(model, w, expected));
    for (std::size_t c = 0; c < kRanged; ++c) {
      if (std::isnan(value[c])) continue;
      range.lowest[c] = seen[c] ? std::min(range.lowest[c], value[c]) : value[c];
      range.highest[c] = seen[c] ? std::max(range.highest[c], value[c]) : value[c];
      seen[c] = true;
    }
  }
  return range;
}

Eigen::MatrixXd columns_beyond(const WindowModel& model, std::span<const double> expected,
                               const SmoothScale& scale, const SmoothRange& range) {
  // How far each window lies beyond either end, segment by segment.
  std::vector<std::array<double, kBeyondFunctions>> beyond(model.windows().size());
  std::array<bool, kBeyondFunctions> there{};
  for (std::size_t w = 0; w < beyond.size(); ++w) {
    if (!model.used(w)) continue;
    const std::array<double, kRanged> value = ranged(met_by(model, w, expected));
    for (std::size_t c = 0; c < kRanged; ++c) {
      if (std::isnan(value[c])) continue;
      std::array<double, 2> over{range.lowest[c] - value[c], value[c] - range.highest[c]};
      const bool is_first = std::find(kFirstOfKind.begin(), kFirstOfKind.end(), c) != kFirstOfKind.end();
      if (is_first && !range.seen[c]) over[1] = kUnmet + std::max(0.0, over[1]);
      for (std::size_t side = 0; side < over.size(); ++side)
        for (std::size_t k = 0; k < kSegments; ++k) {
          const double in = std::max(0.0, over[side] - kSegment * static_cast<double>(k));
          const std::size_t at = (2 * c + side) * kSegments + k;
          beyond[w][at] = kBeyond * (k + 1 < kSegments ? std::min(in, kSegment) : in);
          there[at] = there[at] || in > 0.0;
        }
    }
  }
  std::vector<Eigen::VectorXd> columns;
  for (std::size_t side = 0; side < there.size(); ++side) {
    if (!there[side]) continue;
    for (std::size_t c = 0; c < channel_count(); ++c)
      for (std::size_t copy = 0; copy < copies_of(channel_catalogue()[c], *model.campaign().rover); ++copy) {
        Eigen::VectorXd column = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(model.observation_count()));
        for (std::size_t w = 0; w < beyond.size(); ++w)
          for (std::size_t i = 0; i < model.windows()[w].observations.size(); ++i) {
            const Observation& o = model.windows()[w].observations[i];
            if (static_cast<std::size_t>(o.channel) == c &&
                static_cast<std::size_t>(std::max(0, o.wheel)) == copy)
              column[static_cast<Eigen::Index>(model.offset(w) + i)] = scale.unit[c] * beyond[w][side];
          }
        if (!column.isZero(0.0)) columns.push_back(std::move(column));
      }
  }
  Eigen::MatrixXd all(static_cast<Eigen::Index>(model.observation_count()),
                      static_cast<Eigen::Index>(columns.size()));
  for (std::size_t k = 0; k < columns.size(); ++k) all.col(static_cast<Eigen::Index>(k)) = columns[k];
  return all;
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
