#include "research/benchmark/drive_kind.h"

#include <algorithm>
#include <cmath>

#include "core/angle.h"

namespace slipway::gap {
namespace {

// The gradient in degrees along the rover's x axis (positive uphill) and to its left.
Eigen::Vector2d tilt_of(const DriveKind& kind) {
  const double heading = rad_from_deg(kind.heading_deg);
  // Headed left of uphill, uphill is to the right.
  return kind.tilt_deg * Eigen::Vector2d(std::cos(heading), -std::sin(heading));
}

double sense_of(const DriveKind& kind) {
  return kind.turn_in_place ? 0.0 : kind.speed_m_s < 0.0 ? -1.0 : 1.0;
}

// The standard deviation of a quantity over all kinds; 1 where all are equal.
template <class Value>
double spread_of(std::span<const DriveKind> kinds, const Value& value) {
  double sum = 0.0, squares = 0.0, count = 0.0;
  for (const DriveKind& kind : kinds) {
    const std::optional<double> v = value(kind);
    if (!v) continue;
    sum += *v;
    squares += *v * *v;
    ++count;
  }
  if (count < 2.0) return 1.0;
  const double variance = squares / count - sum * sum / (count * count);
  return variance > 1e-12 * (1.0 + squares / count) ? std::sqrt(variance) : 1.0;
}

}  // namespace

DriveKind kind_of(const DriveCampaign& campaign, std::size_t drive) {
  const MeasuredDriveSeries& series = campaign.drives[drive];
  const sim::Ground& ground = *campaign.terrains[series.terrain].ground;
  DriveKind kind;
  kind.turn_in_place = series.command.turn_in_place;
  if (!kind.turn_in_place) {
    kind.speed_m_s = series.command.speed_m_s;
    kind.curvature_1_m = series.command.curvature_1_m;
  }
  Eigen::Vector2d along_and_left = Eigen::Vector2d::Zero();
  double poses = 0.0, temperatures = 0.0, temperature_c = 0.0;
  for (const DriveSample& sample : series.samples) {
    for (const WheelReading& wheel : sample.wheels)
      if (std::isfinite(wheel.motor_temp_c)) {
        temperature_c += wheel.motor_temp_c;
        ++temperatures;
      }
    if (!sample.p_MB.allFinite() || !std::isfinite(sample.attitude.yaw_rad)) continue;
    const auto point = ground.at(sample.p_MB.x(), sample.p_MB.y());
    if (!point) continue;
    const Eigen::Vector2d uphill = -point->normal.head<2>() / point->normal.z();
    const double c = std::cos(sample.attitude.yaw_rad), s = std::sin(sample.attitude.yaw_rad);
    along_and_left += Eigen::Vector2d(c * uphill.x() + s * uphill.y(), -s * uphill.x() + c * uphill.y());
    ++poses;
  }
  if (poses > 0.0) along_and_left /= poses;
  kind.tilt_deg = deg_from_rad(std::atan(along_and_left.norm()));
  kind.heading_deg = deg_from_rad(std::atan2(-along_and_left.y(), along_and_left.x()));
  if (temperatures > 0.0) kind.motor_temp_c = temperature_c / temperatures;
  return kind;
}

DriveKind kind_of(const NextDrive& drive) {
  return {.tilt_deg = drive.tilt_deg,
          .heading_deg = drive.heading_deg,
          .speed_m_s = drive.speed_m_s,
          .curvature_1_m = drive.curvature_1_m,
          .motor_temp_c = drive.motor_temp_c};
}

DriveDistance::DriveDistance(std::span<const DriveKind> pool) {
  const double along = spread_of(pool, [](const DriveKind& k) { return std::optional(tilt_of(k).x()); });
  const double across = spread_of(pool, [](const DriveKind& k) { return std::optional(tilt_of(k).y()); });
  tilt_deg_ = std::max(along, across);
  speed_m_s_ = spread_of(pool, [](const DriveKind& k) { return std::optional(std::abs(k.speed_m_s)); });
  sense_ = spread_of(pool, [](const DriveKind& k) { return std::optional(sense_of(k)); });
  curvature_1_m_ = spread_of(pool, [](const DriveKind& k) { return std::optional(k.curvature_1_m); });
  motor_temp_c_ = spread_of(pool, [](const DriveKind& k) { return k.motor_temp_c; });
  turn_ = spread_of(pool, [](const DriveKind& k) { return std::optional(k.turn_in_place ? 1.0 : 0.0); });
}

double DriveDistance::between(const DriveKind& a, const DriveKind& b) const {
  double square = ((tilt_of(a) - tilt_of(b)) / tilt_deg_).squaredNorm();
  square += std::pow((sense_of(a) * tilt_of(a).x() - sense_of(b) * tilt_of(b).x()) / tilt_deg_, 2);
  square += std::pow((std::abs(a.speed_m_s) - std::abs(b.speed_m_s)) / speed_m_s_, 2);
  square += std::pow((sense_of(a) - sense_of(b)) / sense_, 2);
  square += std::pow((a.curvature_1_m - b.curvature_1_m) / curvature_1_m_, 2);
  if (a.motor_temp_c && b.motor_temp_c)
    square += std::pow((*a.motor_temp_c - *b.motor_temp_c) / motor_temp_c_, 2);
  if (a.turn_in_place != b.turn_in_place) square += 1.0 / (turn_ * turn_);
  return std::sqrt(square);
}

std::size_t nearest_drive(const DriveDistance& distance, std::span<const DriveKind> kinds,
                          std::span<const std::size_t> among, const DriveKind& asked) {
  return *std::min_element(among.begin(), among.end(), [&](std::size_t a, std::size_t b) {
    return distance.between(kinds[a], asked) < distance.between(kinds[b], asked);
  });
}

}  // namespace slipway::gap
