#include "sim/rover/multipass.h"

#include <cmath>
#include <limits>
#include <numbers>

namespace slipway::sim {
namespace {

// A wheel's place on its line of travel: how far along (m), and which line (m across).
struct TrackPlace {
  double along_m = 0.0;
  double across_m = 0.0;
};

class Tracks {
 public:
  explicit Tracks(const DriveCommand& command)
      : forward_(travel_direction(command)),
        leftward_(-forward_.y(), forward_.x()),
        curvature_(command.curvature_1_m),
        sign_(command.speed_m_s < 0.0 ? -1.0 : 1.0) {}

  TrackPlace of(const WheelModel& wheel) const {
    const Eigen::Vector2d p = wheel.position_m.head<2>();
    const double x = forward_.dot(p), y = leftward_.dot(p);
    if (std::abs(curvature_) < kStraightest_1_m) return {sign_ * x, y};
    // About the turn's centre at (0, 1 / curvature): arc length of B's path and distance to B's circle.
    const double turn_left = curvature_ > 0.0 ? 1.0 : -1.0;
    const double radius = 1.0 / std::abs(curvature_);
    const double inward = turn_left * y;  // towards the centre
    return {sign_ * radius * std::atan2(x, radius - inward), std::hypot(x, radius - inward)};
  }

  // How far ahead, along the line; on a circle never more than half way round.
  double ahead_m(const TrackPlace& other, const TrackPlace& self) const {
    const double d = other.along_m - self.along_m;
    if (std::abs(curvature_) < kStraightest_1_m) return d;
    return std::remainder(d, 2.0 * std::numbers::pi / std::abs(curvature_));
  }

 private:
  static constexpr double kStraightest_1_m = 1e-9;

  Eigen::Vector2d forward_, leftward_;
  double curvature_, sign_;
};

}  // namespace

PerWheel<int> leaders(const RoverModel& rover, const DriveCommand& command) {
  PerWheel<int> leader(rover.wheels.size(), -1);
  if (command.turn_in_place) return leader;
  const Tracks tracks(command);
  PerWheel<TrackPlace> place(rover.wheels.size());
  for (std::size_t k = 0; k < place.size(); ++k) place[k] = tracks.of(rover.wheels[k]);
  for (std::size_t k = 0; k < place.size(); ++k) {
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t m = 0; m < place.size(); ++m) {
      const double ahead = tracks.ahead_m(place[m], place[k]);
      const double reach = 0.5 * (rover.wheels[k].width_m + rover.wheels[m].width_m);
      // Side by side is not ahead: a wheel leads where it is in front by more than rounding.
      if (ahead < 1e-6 || ahead >= nearest || std::abs(place[m].across_m - place[k].across_m) >= reach)
        continue;
      nearest = ahead;
      leader[k] = static_cast<int>(m);
    }
  }
  return leader;
}

double rut_share(double stiffening, double n) {
  return 1.0 - std::pow(1.0 + stiffening, -1.0 / n);
}

PerWheel<double> total_sinkages_m(const PerWheel<int>& leaders, const PerWheel<double>& rut_shares,
                                  const PerWheel<double>& own_sinkage_m) {
  PerWheel<double> total(own_sinkage_m.size());
  for (std::size_t k = 0; k < total.size(); ++k) {
    // From wheel to leader and on to the leader's leader. No more links than wheels: on the tightest circle
    // "ahead" could go round.
    double share = 1.0;
    int at = static_cast<int>(k);
    for (std::size_t link = 0; link < total.size() && at >= 0; ++link) {
      total[k] += share * own_sinkage_m[at];
      share *= rut_shares[at];
      at = leaders[at];
    }
  }
  return total;
}

}  // namespace slipway::sim
