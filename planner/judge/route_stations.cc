#include "planner/judge/route_stations.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/angle.h"

namespace slipway::planner {
namespace {

constexpr double kMaxTurnStep_rad = rad_from_deg(15.0);
constexpr double kNoTurn_rad = 1e-9;

void append_turn(std::vector<sim::PathStation>& path, double turn_rad, const Pose2& end) {
  if (std::abs(turn_rad) < kNoTurn_rad) return;
  const int pieces = static_cast<int>(std::ceil(std::abs(turn_rad) / kMaxTurnStep_rad - 1e-9));
  const double start = end.yaw_rad - turn_rad;
  for (int k = 1; k <= pieces; ++k) {
    sim::PathStation station;
    station.pose = {end.x_m, end.y_m, k == pieces ? end.yaw_rad : wrapped_rad(start + turn_rad * k / pieces)};
    station.distance_m = path.back().distance_m;
    station.turned_rad = turn_rad / pieces;
    station.turning_in_place = true;
    path.push_back(station);
  }
}

void append_drive(std::vector<sim::PathStation>& path, const Motion& motion, double spacing_m) {
  if (motion.length_m <= 0.0) return;
  const int pieces = static_cast<int>(std::ceil(motion.length_m / spacing_m - 1e-9));
  const double before = path.back().distance_m;
  // At whole spacings from the motion's beginning, so that a shorter motion has the stations of a longer one.
  for (int k = 1; k <= pieces; ++k) {
    const double driven = std::min(motion.length_m, spacing_m * k);
    sim::PathStation station;
    station.pose = motion.at(driven);
    station.distance_m = before + driven;
    station.curvature_1_m = motion.curvature_1_m;
    path.push_back(station);
  }
  path.back().pose.x_m = motion.to.x_m;
  path.back().pose.y_m = motion.to.y_m;
  path.back().pose.yaw_rad = wrapped_rad(motion.to.yaw_rad - motion.last_turn_rad);
}

}  // namespace

std::vector<sim::PathStation> route_stations(const std::vector<Motion>& motions, double spacing_m) {
  if (motions.empty()) throw std::invalid_argument("a route has at least one motion");
  std::vector<sim::PathStation> path(1);
  path.front().pose = motions.front().from;
  for (const Motion& motion : motions) {
    append_turn(path, motion.first_turn_rad,
                {motion.from.x_m, motion.from.y_m, wrapped_rad(motion.departure_rad())});
    append_drive(path, motion, spacing_m);
    append_turn(path, motion.last_turn_rad, motion.to);
  }
  return path;
}

const sim::StationPrediction& station_at(const sim::DrivePrediction& drive, double at_m) {
  const auto station = std::find_if(
      drive.stations.begin(), drive.stations.end(),
      [&](const sim::StationPrediction& each) { return each.station.distance_m >= at_m - 1e-9; });
  return station == drive.stations.end() ? drive.stations.back() : *station;
}

}  // namespace slipway::planner
