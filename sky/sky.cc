#include "sky/sky.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "sky/mars_time.h"

namespace slipway::sky {

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
  for (std::size_t k = 0; k + 1 < samples_.size(); ++k) {
    const SkySample &from = samples_[k], &to = samples_[k + 1];
    sun_.emplace_back(from.sun, to.sun);
    if (from.earth && to.earth) earth_.emplace_back(*from.earth, *to.earth);
  }
}

SkyTable::Arc::Arc(const Bearing& first, const Bearing& last)
    : from(towards(first)), to(towards(last)), angle_rad(std::atan2(from.cross(to).norm(), from.dot(to))) {}

Bearing SkyTable::Arc::at(double share) const {
  if (angle_rad < 1e-9) return bearing_of(from);
  return bearing_of(std::sin((1.0 - share) * angle_rad) * from + std::sin(share * angle_rad) * to);
}

std::optional<SkyTable::Between> SkyTable::between(std::int64_t utc_ms) const {
  if (utc_ms < samples_.front().utc_ms || utc_ms > samples_.back().utc_ms) return std::nullopt;
  auto after = std::upper_bound(samples_.begin(), samples_.end(), utc_ms,
                                [](std::int64_t at, const SkySample& sample) { return at < sample.utc_ms; });
  if (after == samples_.end()) --after;
  const SkySample &to = *after, &from = *std::prev(after);
  return Between{static_cast<std::size_t>(&from - samples_.data()),
                 static_cast<double>(utc_ms - from.utc_ms) / static_cast<double>(to.utc_ms - from.utc_ms)};
}

std::optional<Bearing> SkyTable::sun(std::int64_t utc_ms) const {
  const auto at = between(utc_ms);
  if (!at) return std::nullopt;
  return sun_[at->arc].at(at->share);
}

std::optional<Bearing> SkyTable::earth(std::int64_t utc_ms) const {
  const auto at = between(utc_ms);
  if (!at || earth_.empty()) return std::nullopt;
  return earth_[at->arc].at(at->share);
}

double SkyTable::sun_distance_au(std::int64_t utc_ms) const {
  const auto at = between(utc_ms);
  return samples_[at ? at->arc : 0].sun_distance_au;
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
