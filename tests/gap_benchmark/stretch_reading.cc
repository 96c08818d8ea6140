#include "stretch_reading.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sensor_errors.h"

namespace slipway::gap_benchmark {
namespace {

constexpr double kStretch_m = 1.5, kStretch_rad = 0.8;

}  // namespace

std::vector<Stretch> stretches_of(const MadeDrive& drive) {
  const std::vector<DriveRow>& rows = drive.rows;
  const double start_s = rows.front().time_s, duration_s = rows.back().time_s - start_s;
  const double step_s = rows[1].time_s - start_s;
  const double asked_s = drive.order.turn_in_place ? kStretch_rad / std::abs(drive.order.turn_rate_rad_s())
                                                   : kStretch_m / std::abs(drive.order.speed_m_s);
  const long count = std::max(1L, std::lround(duration_s / std::max(asked_s, 2.0 * step_s)));
  std::vector<Stretch> stretches;
  std::size_t from = 0;
  for (long i = 1; i <= count; ++i) {
    const double end_s = start_s + duration_s * static_cast<double>(i) / static_cast<double>(count);
    std::size_t to = from;
    while (to + 1 < rows.size() && rows[to].time_s < end_s - 1e-9) ++to;
    if (to > from) stretches.push_back({from, to});
    from = to;
  }
  return stretches;
}

Reading reading_of(const DriveOrder& order, const DriveRow& row) {
  const RoverMotion& m = row.motion;
  const double ahead = m.forward_m_s * std::cos(m.pitch_rad) +
                       m.left_m_s * std::sin(m.pitch_rad) * std::sin(m.roll_rad),
               aside = m.left_m_s * std::cos(m.roll_rad);
  const double off = m.heading_rad - row.yaw_rad;
  const double level_ahead = std::cos(off) * ahead - std::sin(off) * aside,
               level_aside = std::sin(off) * ahead + std::cos(off) * aside;
  const double left = level_aside / std::cos(row.roll_rad);
  const double forward =
      (level_ahead - left * std::sin(row.pitch_rad) * std::sin(row.roll_rad)) / std::cos(row.pitch_rad);
  const double turned = m.recorded_turn_rad_s * std::cos(row.pitch_rad) / std::cos(row.roll_rad);
  Reading reading;
  if (order.turn_in_place) {
    reading[kSlip] = {1.0 - turned / order.turn_rate_rad_s()};
  } else {
    reading[kSlip] = {1.0 - forward / order.speed_m_s};
    reading[kSideSlip] = {left / std::abs(order.speed_m_s)};
    reading[kYawRate] = {turned - order.turn_rate_rad_s()};
  }
  reading[kRoll] = {row.roll_rad};
  reading[kPitch] = {row.pitch_rad};
  for (const WheelRow& wheel : row.wheels) {
    reading[kCurrent].push_back(wheel.current_a);
    reading[kSinkage].push_back(wheel.sinkage_m);
  }
  return reading;
}

double sensor_deviation(std::size_t channel, const DriveOrder& order, std::span<const DriveRow> rows,
                        std::size_t surveyed, double mean) {
  double middle_s = 0.0, spread = 0.0;
  const auto n = static_cast<double>(rows.size());
  for (const DriveRow& row : rows) middle_s += row.time_s / n;
  for (const DriveRow& row : rows) spread += std::pow(row.time_s - middle_s, 2);
  const double attitude = kAttitudeStd_deg * std::numbers::pi / 180.0;
  const double speed = kPositionStd_m / std::sqrt(spread) / std::abs(order.speed_m_s);
  switch (channel) {
    case kSlip:
      return order.turn_in_place ? attitude / std::sqrt(spread) / std::abs(order.turn_rate_rad_s()) : speed;
    case kSideSlip:
      return std::hypot(speed, attitude / std::sqrt(n));
    case kYawRate:
      return attitude / std::sqrt(spread);
    case kCurrent:
      return std::hypot(kCurrentStd_a, kCurrentRel * mean) / std::sqrt(n);
    case kSinkage:
      return kSinkageStd_m / std::sqrt(static_cast<double>(surveyed));
    default:
      return attitude / std::sqrt(n);
  }
}

std::vector<std::optional<DriveRow>> replayed(const SealedCampaign& campaign, const World& world,
                                              const MadeDrive& drive, std::span<const DriveRow> at) {
  for (const NamedTerrain& terrain : campaign.terrains) {
    if (terrain.name != drive.order.terrain) continue;
    RandomStream random(drive.soil_seed);
    return replay_drive(world, terrain.grid, drive.order, random, at);
  }
  return std::vector<std::optional<DriveRow>>(at.size());
}

MeanReading mean_reading_of(const MadeDrive& drive, const Stretch& stretch,
                            std::span<const std::optional<DriveRow>> without) {
  MeanReading of;
  for (std::size_t i = stretch.from; i <= stretch.to; ++i) {
    if (!without[i]) continue;
    const Reading with = reading_of(drive.order, drive.rows[i]), bare = reading_of(drive.order, *without[i]);
    for (std::size_t c = 0; c < with.size(); ++c) {
      if (c == kSinkage && !drive.rows[i].surveyed) continue;
      ++of.rows[c];
      of.mean[c].resize(with[c].size());
      of.change[c].resize(with[c].size());
      for (std::size_t k = 0; k < with[c].size(); ++k) {
        of.mean[c][k] += with[c][k];
        of.change[c][k] += with[c][k] - bare[c][k];
      }
    }
  }
  for (std::size_t c = 0; c < of.rows.size(); ++c)
    for (std::size_t k = 0; k < of.mean[c].size(); ++k) {
      of.mean[c][k] /= static_cast<double>(of.rows[c]);
      of.change[c][k] /= static_cast<double>(of.rows[c]);
    }
  return of;
}

}  // namespace slipway::gap_benchmark
