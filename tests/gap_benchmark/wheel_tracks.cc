#include "wheel_tracks.h"

#include <algorithm>
#include <cmath>

namespace slipway::gap_benchmark {
namespace {

struct Interval {
  double from = 0.0, to = 0.0;

  double share_in(const Interval& other) const {
    return std::max(0.0, std::min(to, other.to) - std::max(from, other.from)) / (to - from);
  }
};

// One strip after a wheel whose rut begins at `right_m`.
SoilNode after_pass(const SoilNode& node, const Interval& strip, const Rut& rut, double right_m,
                    double width_m) {
  const double step = width_m / static_cast<double>(rut.across.size());
  SoilNode after;
  double untouched = 1.0;
  const auto add = [&](const SoilNode& part, double share) {
    after.origin_m += share * part.origin_m;
    after.plastic_m += share * part.plastic_m;
    after.yield_pa += share * part.yield_pa;
  };
  for (std::size_t s = 0; s < rut.across.size(); ++s) {
    const double from = right_m + static_cast<double>(s) * step;
    const double share = strip.share_in({from, from + step});
    add(rut.across[s], share);
    untouched -= share;
  }
  add(node, std::max(untouched, 0.0));
  const double berms = strip.share_in({right_m - rut.berm_width_m, right_m}) +
                       strip.share_in({right_m + width_m, right_m + width_m + rut.berm_width_m});
  after.origin_m += berms * rut.berm_height_m;
  return after;
}

}  // namespace

Tracks tracks_of(const RoverOnFile& rover, const BalanceState& state) {
  const double vx = state.forward_m_s, vy = state.left_m_s, w = state.yaw_rate_rad_s;
  const double speed = std::max(std::hypot(vx, vy), 1e-5);
  Tracks tracks;
  for (std::size_t i = 0; i < kWheels; ++i) {
    const Eigen::Vector2d& p = rover.wheel_m[i];
    tracks.lane_m[i] = std::abs(w) / speed > 1e-3
                           ? std::hypot(vx - w * p.y(), vy + w * p.x()) / std::abs(w) * (w > 0 ? -1.0 : 1.0)
                           : (vx * p.y() - vy * p.x()) / speed;
    tracks.station_m[i] = (vx * p.x() + vy * p.y()) / speed;
  }
  return tracks;
}

std::vector<SoilNode> soil_met(int wheel, const Tracks& tracks, const std::array<Rut, kWheels>& ruts,
                               double width_m) {
  std::vector<std::size_t> ahead;
  for (int i = 0; i < kWheels; ++i)
    if (tracks.is_ahead(i, wheel) && !ruts[static_cast<std::size_t>(i)].across.empty())
      ahead.push_back(static_cast<std::size_t>(i));
  std::stable_sort(ahead.begin(), ahead.end(),
                   [&](std::size_t a, std::size_t b) { return tracks.station_m[a] > tracks.station_m[b]; });
  if (ahead.empty()) return {};
  std::vector<SoilNode> met(ruts[ahead.front()].across.size());
  const double right = tracks.lane_m[static_cast<std::size_t>(wheel)] - 0.5 * width_m,
               step = width_m / static_cast<double>(met.size());
  for (const std::size_t i : ahead)
    for (std::size_t s = 0; s < met.size(); ++s) {
      const double from = right + static_cast<double>(s) * step;
      met[s] = after_pass(met[s], {from, from + step}, ruts[i], tracks.lane_m[i] - 0.5 * width_m, width_m);
    }
  return met;
}

}  // namespace slipway::gap_benchmark
