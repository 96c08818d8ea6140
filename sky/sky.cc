#include "sky/sky.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "sky/mars_time.h"

namespace slipway::sky {
namespace {

// A share of the way from one direction to another, along the great circle.
Bearing part_way(const Bearing& from, const Bearing& to, double share) {
  const Eigen::Vector3d a = towards(from), b = towards(to);
  const double angle = std::atan2(a.cross(b).norm(), a.dot(b));
  if (angle < 1e-9) return from;
  return bearing_of((std::sin((1.0 - share) * angle) * a + std::sin(share * angle) * b) / std::sin(angle));
}

}  // namespace

std::optional<Bearing> MarsSky::sun(std::int64_t utc_ms) const {
  return mars_sun(utc_ms, east_longitude_rad_, latitude_rad_);
}

std::optional<Bearing> MarsSky::earth(std::int64_t utc_ms) const {
  return mars_earth(utc_ms, east_longitude_rad_, latitude_rad_);
}

double MarsSky::sun_distance_au(std::int64_t utc_ms) const {
  return mars_time(utc_ms, east_longitude_rad_).sun_distance_au;
}

SkyTable::SkyTable(std::vector<SkySample> samples) : samples_(std::move(samples)) {
  const auto rises = [](const SkySample& a, const SkySample& b) { return a.utc_ms >= b.utc_ms; };
  if (samples_.size() < 2 || std::adjacent_find(samples_.begin(), samples_.end(), rises) != samples_.end())
    throw std::invalid_argument("SkyTable: two moments or more, by rising times");
}

std::optional<SkyTable::Between> SkyTable::between(std::int64_t utc_ms) const {
  if (utc_ms < samples_.front().utc_ms || utc_ms > samples_.back().utc_ms) return std::nullopt;
  auto after = std::upper_bound(samples_.begin(), samples_.end(), utc_ms,
                                [](std::int64_t at, const SkySample& sample) { return at < sample.utc_ms; });
  if (after == samples_.end()) --after;
  const SkySample &to = *after, &from = *std::prev(after);
  return Between{&from, &to,
                 static_cast<double>(utc_ms - from.utc_ms) / static_cast<double>(to.utc_ms - from.utc_ms)};
}

std::optional<Bearing> SkyTable::sun(std::int64_t utc_ms) const {
  const auto at = between(utc_ms);
  if (!at) return std::nullopt;
  return part_way(at->before->sun, at->after->sun, at->share);
}

std::optional<Bearing> SkyTable::earth(std::int64_t utc_ms) const {
  const auto at = between(utc_ms);
  if (!at || !at->before->earth || !at->after->earth) return std::nullopt;
  return part_way(*at->before->earth, *at->after->earth, at->share);
}

double SkyTable::sun_distance_au(std::int64_t utc_ms) const {
  const auto at = between(utc_ms);
  return (at ? *at->before : samples_.front()).sun_distance_au;
}

std::optional<Bearing> SkyOverMap::turned(std::optional<Bearing> bearing) const {
  if (!bearing) return bearing;
  const double azimuth = std::fmod(bearing->azimuth_rad - map_north_rad_, 2.0 * std::numbers::pi);
  bearing->azimuth_rad = azimuth < 0.0 ? azimuth + 2.0 * std::numbers::pi : azimuth;
  return bearing;
}

SkyTable table_of(const Sky& sky, std::int64_t from_ms, std::int64_t to_ms, bool with_earth) {
  constexpr std::int64_t kStep_ms = 300'000;
  std::vector<SkySample> samples;
  for (std::int64_t at = from_ms; at < to_ms + 2 * kStep_ms; at += kStep_ms)
    samples.push_back(
        {at, sky.sun(at).value(), with_earth ? sky.earth(at) : std::nullopt, sky.sun_distance_au(at)});
  return SkyTable(std::move(samples));
}

}  // namespace slipway::sky
