#include "sim/dynamic/drive_leg.h"

#include <cmath>
#include <numbers>

#include "core/angle.h"

namespace slipway::sim {
namespace {

// The line of B's path in the direction of travel, which is backwards where the speed is negative.
struct TravelLine {
  double direction_rad;  // at the start, map frame
  double curvature_1_m;  // positive turns left, seen along the travel
};

TravelLine travel_line(const DriveLeg& leg, const Pose2& start) {
  const DriveCommand& command = leg.command;
  const double ahead = start.yaw_rad + command.crab_rad;
  if (command.speed_m_s < 0.0) return {ahead + std::numbers::pi, -command.curvature_1_m};
  return {ahead, command.curvature_1_m};
}

double sinc(double x) {
  return x == 0.0 ? 1.0 : std::sin(x) / x;
}

// The share of a leg that is done; a leg without length is done.
double share_of(double done, double whole) {
  return whole > 0.0 ? done / whole : 1.0;
}

}  // namespace

double commanded_duration_s(const DriveLeg& leg) {
  return leg.command.turn_in_place ? leg.turn_rad / std::abs(leg.command.turn_rate_rad_s)
                                   : leg.length_m / std::abs(leg.command.speed_m_s);
}

Pose2 commanded_pose(const DriveLeg& leg, const Pose2& start, double share) {
  if (leg.command.turn_in_place) {
    const double turned = std::copysign(leg.turn_rad, leg.command.turn_rate_rad_s) * share;
    return {start.x_m, start.y_m, start.yaw_rad + turned};
  }
  const TravelLine line = travel_line(leg, start);
  const double way = share * leg.length_m;
  const double turned = line.curvature_1_m * way;
  // The chord of an arc lies half way between its directions at both ends.
  const double chord = way * sinc(0.5 * turned), towards = line.direction_rad + 0.5 * turned;
  return {start.x_m + chord * std::cos(towards), start.y_m + chord * std::sin(towards),
          start.yaw_rad + turned};
}

LegPlace place_on_leg(const DriveLeg& leg, const Pose2& start, const Pose2& now, double turned_rad) {
  LegPlace place;
  if (leg.command.turn_in_place) {
    place.share = share_of(leg.command.turn_rate_rad_s < 0.0 ? -turned_rad : turned_rad, leg.turn_rad);
  } else {
    const TravelLine line = travel_line(leg, start);
    const double east = now.x_m - start.x_m, north = now.y_m - start.y_m;
    const double c = std::cos(line.direction_rad), s = std::sin(line.direction_rad);
    const double ahead = c * east + s * north, left = c * north - s * east;
    // The position about the arc's centre, which is at 1 / k to the left, is multiplied by k, so that a
    // straight line is an arc too.
    const double k = line.curvature_1_m;
    double angle = std::atan2(k * ahead, 1.0 - k * left);
    angle += 2.0 * std::numbers::pi * std::round((turned_rad - angle) / (2.0 * std::numbers::pi));
    place.share = share_of(k == 0.0 ? ahead : angle / k, leg.length_m);
    place.across_m =
        (2.0 * left - k * (ahead * ahead + left * left)) / (1.0 + std::hypot(k * ahead, 1.0 - k * left));
  }
  place.heading_rad = wrapped_rad(now.yaw_rad - commanded_pose(leg, start, place.share).yaw_rad);
  return place;
}

}  // namespace slipway::sim
