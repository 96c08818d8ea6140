#include "sim/prediction/path_refinement.h"

#include <algorithm>
#include <cmath>

#include "core/angle.h"

namespace slipway::sim {
namespace {

constexpr double kNearOfShape = 0.85, kNearOfSoil = 0.9;  // of a limit

bool may_pass(double from, double to, double limit, double near) {
  const double largest = std::max(from, to);
  return largest < limit && (largest >= near * limit || largest + std::abs(from - to) >= limit);
}

}  // namespace

bool may_pass_a_limit(const StationRules& rules, const Balanced& from, const Balanced& to, int halvings) {
  const bool moves = from.state.moving() && to.state.moving();
  if (halvings == 0 && moves && !to.ready.command.turn_in_place &&
      may_pass(std::abs(from.state.slip_ratio), std::abs(to.state.slip_ratio), rules.max_slip_ratio(),
               kNearOfSoil))
    return true;
  return std::any_of(rules.active().begin(), rules.active().end(), [&](const StationRules::Active& rule) {
    const bool of_shape = rule.row->of_shape;
    if (!of_shape && (halvings > 0 || !moves)) return false;
    const double a = rules.measure(rule, from.ready.stance, from.state).value;
    const double b = rules.measure(rule, to.ready.stance, to.state).value;
    const double near = of_shape ? kNearOfShape : kNearOfSoil;
    // A limit from below is one from above of the value without its sign.
    if (rule.row->trips == Trips::kBelow)
      return std::min(a, b) >= rule.limit && std::min(a, b) - std::abs(a - b) < rule.limit;
    return may_pass(a, b, rule.limit, near);
  });
}

std::pair<PathStation, PathStation> halved(const PathStation& from, const PathStation& to) {
  PathStation halfway = to, rest = to;
  halfway.turned_rad = rest.turned_rad = 0.5 * to.turned_rad;
  halfway.distance_m = 0.5 * (from.distance_m + to.distance_m);
  halfway.pose.yaw_rad =
      to.turning_in_place
          ? wrapped_rad(to.pose.yaw_rad - 0.5 * to.turned_rad)
          : wrapped_rad(from.pose.yaw_rad + 0.5 * wrapped_rad(to.pose.yaw_rad - from.pose.yaw_rad));
  // The arc's middle lies beside the chord's, away from the side to which it curves, by curvature s^2 / 8.
  const double length_m = to.distance_m - from.distance_m, beside = to.curvature_1_m * length_m * 0.125;
  const double dx = to.pose.x_m - from.pose.x_m, dy = to.pose.y_m - from.pose.y_m;
  halfway.pose.x_m = 0.5 * (from.pose.x_m + to.pose.x_m) + beside * dy;
  halfway.pose.y_m = 0.5 * (from.pose.y_m + to.pose.y_m) - beside * dx;
  return {halfway, rest};
}

}  // namespace slipway::sim
