#include "sim/rover/multipass.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace slipway::sim {
namespace {

// A wheel's place on its line of travel: how far along (m; on a circle as B goes, an angle times B's radius),
// and which line (m across).
struct TrackPlace {
  double along_m = 0.0;
  double across_m = 0.0;
};

// The lines of a rover's places in steady motion: straight, or circles about the turn's centre, which is
// 1 / curvature to the left of B.
class Tracks {
 public:
  Tracks(const Eigen::Vector2d& velocity, double yaw_rate)
      : forward_(velocity.normalized()),
        leftward_(-forward_.y(), forward_.x()),
        curvature_(yaw_rate / velocity.norm()) {}

  // Written so that circles become straight lines without a step and without loss of digits.
  TrackPlace of(const WheelModel& wheel) const {
    const Eigen::Vector2d p = wheel.position_m.head<2>();
    const double x = forward_.dot(p), y = leftward_.dot(p);
    // Of the turn's centre, times the curvature.
    const double along = curvature_ * x, across = 1.0 - curvature_ * y;
    const double away = std::sqrt(along * along + across * across);
    return {is_straight() ? x : std::atan2(along, across) / curvature_,
            (2.0 * y - curvature_ * (x * x + y * y)) / (1.0 + away)};
  }

  // How far ahead, along the line; on a circle never more than half way round.
  double ahead_m(const TrackPlace& other, const TrackPlace& self) const {
    const double d = other.along_m - self.along_m;
    return is_straight() ? d : std::remainder(d, 2.0 * std::numbers::pi / std::abs(curvature_));
  }

 private:
  bool is_straight() const { return std::abs(curvature_) < 1e-9; }

  Eigen::Vector2d forward_, leftward_;
  double curvature_;  // 1/m
};

struct Interval {
  double from_m = 0.0, to_m = 0.0;
};

// A part of a wheel's width as the pieces of it on which no track has been found yet.
class FreshWidth {
 public:
  explicit FreshWidth(const Interval& whole) : count_(1) { pieces_[0] = whole; }

  // Takes a track's width off, and returns how much that was.
  double take_off(const Interval& track) {
    double taken = 0.0;
    const std::size_t before = count_;
    for (std::size_t i = 0; i < before; ++i) {
      const Interval piece = pieces_[i];
      const double from = std::clamp(track.from_m, piece.from_m, piece.to_m);
      const double to = std::clamp(track.to_m, piece.from_m, piece.to_m);
      if (to <= from) continue;
      taken += to - from;
      if (from <= piece.from_m) {
        pieces_[i].from_m = to;
        continue;
      }
      pieces_[i].to_m = from;
      if (to < piece.to_m) pieces_[count_++] = {to, piece.to_m};
    }
    return taken;
  }

 private:
  std::array<Interval, kMaxWheels> pieces_;  // a track cuts one of them at most into two
  std::size_t count_;
};

}  // namespace

TrackShares tracks_followed(const RoverModel& rover, const Eigen::Vector2d& velocity, double yaw_rate) {
  // Side by side is not ahead: a wheel leads where it is in front by more than rounding.
  constexpr double kAhead_m = 1e-6;
  const auto count = static_cast<Eigen::Index>(rover.wheels.size());
  TrackShares shares = TrackShares::Zero(count, count);
  if (velocity.isZero()) return shares;
  const Tracks tracks(velocity, yaw_rate);
  PerWheel<TrackPlace> place(rover.wheels.size());
  PerWheel<Interval> width(rover.wheels.size());
  for (std::size_t k = 0; k < place.size(); ++k) {
    place[k] = tracks.of(rover.wheels[k]);
    const double half = 0.5 * rover.wheels[k].width_m;
    width[k] = {place[k].across_m - half, place[k].across_m + half};
  }
  struct Leader {
    double ahead_m = 0.0;
    Eigen::Index wheel = 0;
  };
  for (Eigen::Index k = 0; k < count; ++k) {
    std::array<Leader, kMaxWheels> leaders;
    std::size_t found = 0;
    for (Eigen::Index m = 0; m < count; ++m) {
      if (m == k || width[m].from_m >= width[k].to_m || width[k].from_m >= width[m].to_m) continue;
      const double ahead = tracks.ahead_m(place[m], place[k]);
      if (ahead >= kAhead_m) leaders[found++] = {ahead, m};
    }
    std::sort(leaders.begin(), leaders.begin() + found,
              [](const Leader& a, const Leader& b) { return a.ahead_m < b.ahead_m; });
    FreshWidth fresh(width[k]);
    for (std::size_t i = 0; i < found; ++i)
      shares(k, leaders[i].wheel) = fresh.take_off(width[leaders[i].wheel]) / rover.wheels[k].width_m;
  }
  return shares;
}

double rut_share(double stiffening, double n) {
  return 1.0 - std::pow(1.0 + stiffening, -1.0 / n);
}

// From wheel to leader and on to the leader's leader. No more links than wheels: on the tightest circle
// "ahead" could go round.
PerWheel<double> total_sinkages_m(const TrackShares& shares, const PerWheel<double>& rut_shares,
                                  const PerWheel<double>& own_sinkage_m) {
  using Depths = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxWheels, 1>;
  const Eigen::Index count = shares.rows();
  const Eigen::Map<const Depths> own(own_sinkage_m.data(), count), rut(rut_shares.data(), count);
  Depths added = own, total = own;
  for (Eigen::Index link = 1; link < count && !added.isZero(0.0); ++link) {
    added = rut.cwiseProduct(shares * added).eval();
    total += added;
  }
  PerWheel<double> depths(own_sinkage_m.size());
  std::copy(total.begin(), total.end(), depths.begin());
  return depths;
}

}  // namespace slipway::sim
