#include "planner/problem/motion.h"

#include <cmath>
#include <numbers>

#include "core/angle.h"

namespace slipway::planner {
namespace {

// Nearer than this two places are one, and a chord has no bearing.
constexpr double kSamePlace_m = 1e-6;
// Half the sweep of the widest arc: beyond it the arc is much longer than its chord and a turn is shorter.
constexpr double kMaxHalfSweep = std::numbers::pi / 3.0;
// Flatter than this an arc is a straight: its sagitta over 100 m is under a millimetre.
constexpr double kStraightCurvature_1_m = 1e-6;

}  // namespace

double Motion::turned_rad() const {
  return std::abs(first_turn_rad) + std::abs(last_turn_rad);
}

Pose2 Motion::at(double driven_m) const {
  const double start = departure_rad();
  // The chord of an arc of sweep a has the direction start + a/2 and the length s sin(a/2) / (a/2).
  const double half = 0.5 * curvature_1_m * driven_m;
  const double chord = std::abs(half) < 1e-9 ? driven_m : driven_m * std::sin(half) / half;
  return {from.x_m + chord * std::cos(start + half), from.y_m + chord * std::sin(start + half),
          wrapped_rad(start + 2.0 * half)};
}

MotionLimits motion_limits(const sim::RoverModel& rover) {
  return {.min_turn_radius_m = rover.min_turn_radius_m,
          .cruise_speed_m_s = rover.cruise_speed_m_s,
          .turn_rate_rad_s = rover.turn_rate_rad_s};
}

Motion connect(const Pose2& from, const Pose2& to, const MotionLimits& limits) {
  Motion motion{.from = from, .to = to};
  const double dx = to.x_m - from.x_m;
  const double dy = to.y_m - from.y_m;
  const double chord = std::hypot(dx, dy);
  if (chord < kSamePlace_m) {
    motion.first_turn_rad = wrapped_rad(to.yaw_rad - from.yaw_rad);
    return motion;
  }
  const double bearing = std::atan2(dy, dx);
  const double half_sweep = wrapped_rad(to.yaw_rad - bearing);
  const double curvature = 2.0 * std::sin(half_sweep) / chord;
  const bool arc_fits =
      std::abs(half_sweep) <= kMaxHalfSweep && std::abs(curvature) * limits.min_turn_radius_m <= 1.0;
  if (arc_fits && std::abs(curvature) > kStraightCurvature_1_m) {
    motion.curvature_1_m = curvature;
    motion.length_m = 2.0 * half_sweep / curvature;
    motion.first_turn_rad = wrapped_rad(bearing - half_sweep - from.yaw_rad);
  } else {
    motion.length_m = chord;
    motion.first_turn_rad = wrapped_rad(bearing - from.yaw_rad);
    motion.last_turn_rad = half_sweep;
  }
  return motion;
}

Motion straight(const Pose2& from, double x_m, double y_m) {
  const double dx = x_m - from.x_m;
  const double dy = y_m - from.y_m;
  const double length = std::hypot(dx, dy);
  const double bearing = length < kSamePlace_m ? from.yaw_rad : std::atan2(dy, dx);
  return {.from = from,
          .to = {x_m, y_m, bearing},
          .first_turn_rad = wrapped_rad(bearing - from.yaw_rad),
          .length_m = length};
}

double duration_s(const Motion& motion, const MotionLimits& limits) {
  return motion.length_m / limits.cruise_speed_m_s + motion.turned_rad() / limits.turn_rate_rad_s;
}

}  // namespace slipway::planner
