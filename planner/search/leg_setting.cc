#include "planner/search/leg_setting.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/angle.h"

namespace slipway::planner {
namespace {

constexpr double kSharedEnds = 0.12;  // of a leg, at both ends, where no band is

// Three times as many gain some 0.3 % of the cost on a 300 m leg (bench/plan_bench).
int iterations_for(double length_m) {
  return static_cast<int>(std::clamp(800.0 + 4.0 * length_m, 1000.0, 4000.0));
}

double range_for(double length_m) {
  return std::clamp(length_m / 15.0, 4.0, 16.0);
}

// With a free heading: the straight line's, and to both sides of it.
std::vector<double> arrivals(const Waypoint& from, const Waypoint& to) {
  if (to.yaw_rad) return {wrapped_rad(*to.yaw_rad)};
  const double direct = std::atan2(to.y_m - from.y_m, to.x_m - from.x_m);
  std::vector<double> headings;
  for (const double aside : {0.0, 30.0, -30.0, 60.0, -60.0, 100.0, -100.0, 180.0})
    headings.push_back(wrapped_rad(direct + rad_from_deg(aside)));
  return headings;
}

}  // namespace

LegSearch leg_between(const MotionCost& cost, const PoseSampler& sampler, const Pose2& at,
                      const Waypoint& from, const Waypoint& to, std::uint64_t seed,
                      std::function<bool()> cancelled) {
  const double length = std::hypot(to.x_m - from.x_m, to.y_m - from.y_m);
  LegSearch search;
  search.cost = &cost;
  search.sampler = &sampler;
  search.from = at;
  search.to_x_m = to.x_m;
  search.to_y_m = to.y_m;
  search.arrival_rad = arrivals(from, to);
  search.seed = seed;
  search.iterations = iterations_for(length);
  search.range_m = range_for(length);
  search.cancelled = std::move(cancelled);
  return search;
}

bool joins(const std::vector<Pose2>& poses, const LegSearch& leg) {
  constexpr double kSameEnd_m = 1e-6;
  return poses.size() >= 2 &&
         std::hypot(poses.front().x_m - leg.from.x_m, poses.front().y_m - leg.from.y_m) < kSameEnd_m &&
         std::hypot(poses.back().x_m - leg.to_x_m, poses.back().y_m - leg.to_y_m) < kSameEnd_m;
}

std::vector<Motion> straight_way(const PlanProblem& problem) {
  const std::vector<Waypoint> places = problem.places();
  std::vector<Motion> motions;
  Pose2 at{places.front().x_m, places.front().y_m, wrapped_rad(places.front().yaw_rad.value_or(0.0))};
  for (std::size_t i = 1; i < places.size(); ++i) {
    Motion motion = straight(at, places[i].x_m, places[i].y_m);
    if (places[i].yaw_rad) {
      const double arrival = wrapped_rad(*places[i].yaw_rad);
      motion.last_turn_rad = wrapped_rad(arrival - motion.to.yaw_rad);
      motion.to.yaw_rad = arrival;
    }
    at = motion.to;
    motions.push_back(motion);
  }
  return motions;
}

void set_down_as_it_leaves(const Waypoint& start, std::vector<Motion>& motions) {
  if (start.yaw_rad) return;
  Motion& first = motions.front();
  first.from.yaw_rad = wrapped_rad(first.departure_rad());
  first.first_turn_rad = 0.0;
}

bool is_near_place(const std::vector<Waypoint>& places, const Eigen::Vector2d& p, double reach_m) {
  for (std::size_t i = 0; i < places.size(); ++i) {
    const Waypoint& other = places[i == 0 ? 1 : i - 1];
    const double leg = std::hypot(other.x_m - places[i].x_m, other.y_m - places[i].y_m);
    if (std::hypot(p.x() - places[i].x_m, p.y() - places[i].y_m) < std::max(2.0 * reach_m, kSharedEnds * leg))
      return true;
  }
  return false;
}

}  // namespace slipway::planner
