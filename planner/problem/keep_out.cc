#include "planner/problem/keep_out.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/angle.h"

namespace slipway::planner {
namespace {

constexpr double kNoTurn_rad = 1e-9;
constexpr double kStraight_1_m = 1e-9;

// Even-odd rule.
bool inside(const Polygon& polygon, const Eigen::Vector2d& p) {
  bool odd = false;
  for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
    const Eigen::Vector2d& a = polygon[i];
    const Eigen::Vector2d& b = polygon[j];
    if ((a.y() > p.y()) == (b.y() > p.y())) continue;
    if (p.x() < a.x() + (b.x() - a.x()) * (p.y() - a.y()) / (b.y() - a.y())) odd = !odd;
  }
  return odd;
}

// Liang-Barsky: does the segment meet the box |x| <= half.x, |y| <= half.y?
bool meets_box(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& half) {
  double enter = 0.0;
  double leave = 1.0;
  for (int axis = 0; axis < 2; ++axis) {
    const double step = b[axis] - a[axis];
    if (step == 0.0) {
      if (std::abs(a[axis]) > half[axis]) return false;
      continue;
    }
    const double t0 = (-half[axis] - a[axis]) / step;
    const double t1 = (half[axis] - a[axis]) / step;
    enter = std::max(enter, std::min(t0, t1));
    leave = std::min(leave, std::max(t0, t1));
  }
  return enter <= leave;
}

// Map places as a body at the pose sees them.
class BodyFrame {
 public:
  explicit BodyFrame(const Pose2& pose)
      : origin_(pose.x_m, pose.y_m), c_(std::cos(pose.yaw_rad)), s_(std::sin(pose.yaw_rad)) {}
  Eigen::Vector2d operator()(const Eigen::Vector2d& place) const {
    const Eigen::Vector2d d = place - origin_;
    return {c_ * d.x() + s_ * d.y(), -s_ * d.x() + c_ * d.y()};
  }

 private:
  Eigen::Vector2d origin_;
  double c_, s_;
};

// Whether a point that is turned about the origin by `turn_rad`, starting at `from`, crosses the segment.
bool arc_meets_segment(const Eigen::Vector2d& from, double turn_rad, const Eigen::Vector2d& a,
                       const Eigen::Vector2d& b) {
  const Eigen::Vector2d along = b - a;
  const double squared = along.squaredNorm();
  // |a + t (b - a)| = |from|
  const double middle = -a.dot(along);
  const double discriminant = middle * middle - squared * (a - from).dot(a + from);
  if (squared == 0.0 || discriminant < 0.0) return false;
  const double root = std::sqrt(discriminant);
  for (const double t : {(middle - root) / squared, (middle + root) / squared}) {
    if (t < 0.0 || t > 1.0) continue;
    const Eigen::Vector2d p = a + t * along;
    double turned = std::atan2(from.x() * p.y() - from.y() * p.x(), from.dot(p));
    if (turn_rad < 0.0) turned = -turned;
    if (turned < 0.0) turned += 2.0 * std::numbers::pi;
    if (turned <= std::abs(turn_rad)) return true;
  }
  return false;
}

}  // namespace

double distance_to_segment_m(const Eigen::Vector2d& p, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  const Eigen::Vector2d along = b - a;
  const double squared = along.squaredNorm();
  const double t = squared > 0.0 ? std::clamp((p - a).dot(along) / squared, 0.0, 1.0) : 0.0;
  return (p - a - t * along).norm();
}

KeepOut::KeepOut(std::span<const Polygon> polygons, const sim::RoverModel& rover,
                 std::span<const Polygon> keep_in)
    : half_(0.5 * rover.body_length_m, 0.5 * rover.body_width_m),
      inscribed_m_(half_.minCoeff()),
      circumscribed_m_(half_.norm()) {
  for (const Polygon& polygon : polygons) add(polygon, false);
  for (const Polygon& polygon : keep_in) add(polygon, true);
}

void KeepOut::add(const Polygon& polygon, bool closes_outside) {
  if (polygon.empty()) return;
  Zone zone{polygon, polygon.front(), polygon.front(), closes_outside};
  for (const Eigen::Vector2d& corner : polygon) {
    zone.low = zone.low.cwiseMin(corner);
    zone.high = zone.high.cwiseMax(corner);
  }
  zones_.push_back(std::move(zone));
}

bool KeepOut::Zone::box_within(const Eigen::Vector2d& point, double distance_m) const {
  if (closes_outside) return true;
  return (low - point).cwiseMax(point - high).cwiseMax(0.0).squaredNorm() <= distance_m * distance_m;
}

bool KeepOut::Zone::holds(const Eigen::Vector2d& point) const {
  return inside(polygon, point) != closes_outside;
}

// A rectangle that meets no edge is wholly on the side where its middle is.
bool KeepOut::Zone::meets_rectangle(const Pose2& pose, const Eigen::Vector2d& half) const {
  if (holds({pose.x_m, pose.y_m})) return true;
  const BodyFrame in_body(pose);
  for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
    if (meets_box(in_body(polygon[j]), in_body(polygon[i]), half)) return true;
  }
  return false;
}

bool KeepOut::within(double x_m, double y_m, double distance_m) const {
  const Eigen::Vector2d p(x_m, y_m);
  return std::any_of(zones_.begin(), zones_.end(), [&](const Zone& zone) {
    if (!zone.box_within(p, distance_m)) return false;
    const Polygon& polygon = zone.polygon;
    if (zone.holds(p)) return true;
    for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
      if (distance_to_segment_m(p, polygon[j], polygon[i]) <= distance_m) return true;
    }
    return false;
  });
}

bool KeepOut::hits(const Pose2& pose) const {
  return std::any_of(zones_.begin(), zones_.end(), [&](const Zone& zone) {
    return zone.box_within({pose.x_m, pose.y_m}, circumscribed_m_) && zone.meets_rectangle(pose, half_);
  });
}

// A body that is clear at the turn's beginning and meets the zone later does so first where a corner of
// the one lies on an edge of the other. Corners of the body circle the centre; seen from the body, those of
// the polygon circle it the other way round.
bool KeepOut::turning_hits(const Zone& zone, const Pose2& from, const Eigen::Vector2d& centre_in_body,
                           double turn_rad) const {
  const Polygon& polygon = zone.polygon;
  if (zone.meets_rectangle(from, half_)) return true;
  if (std::abs(turn_rad) < kNoTurn_rad) return false;
  const BodyFrame in_body(from);
  std::array<Eigen::Vector2d, 4> body{{half_, {-half_.x(), half_.y()}, -half_, {half_.x(), -half_.y()}}};
  for (Eigen::Vector2d& corner : body) corner -= centre_in_body;
  for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
    const Eigen::Vector2d a = in_body(polygon[j]) - centre_in_body;
    const Eigen::Vector2d b = in_body(polygon[i]) - centre_in_body;
    for (std::size_t k = 0; k < body.size(); ++k) {
      if (arc_meets_segment(body[k], turn_rad, a, b)) return true;
      if (arc_meets_segment(b, -turn_rad, body[k], body[(k + 1) % body.size()])) return true;
    }
  }
  return false;
}

bool KeepOut::driving_hits(const Zone& zone, const Motion& motion) const {
  const Pose2 departure{motion.from.x_m, motion.from.y_m, motion.departure_rad()};
  if (std::abs(motion.curvature_1_m) > kStraight_1_m)
    return turning_hits(zone, departure, {0.0, 1.0 / motion.curvature_1_m},
                        motion.curvature_1_m * motion.length_m);
  const double half_way = 0.5 * motion.length_m;
  return zone.meets_rectangle({departure.x_m + half_way * std::cos(departure.yaw_rad),
                               departure.y_m + half_way * std::sin(departure.yaw_rad), departure.yaw_rad},
                              half_ + Eigen::Vector2d(half_way, 0.0));
}

bool KeepOut::hits_along(const Motion& motion) const {
  if (zones_.empty()) return false;
  // No place of an arc or straight is further from its middle than half its length.
  const Pose2 middle = motion.at(0.5 * motion.length_m);
  const double reach = circumscribed_m_ + 0.5 * motion.length_m;
  return std::any_of(zones_.begin(), zones_.end(), [&](const Zone& zone) {
    if (!zone.box_within({middle.x_m, middle.y_m}, reach)) return false;
    return driving_hits(zone, motion) ||
           turning_hits(zone, motion.from, Eigen::Vector2d::Zero(), motion.first_turn_rad) ||
           turning_hits(zone, motion.to, Eigen::Vector2d::Zero(), -motion.last_turn_rad);
  });
}

std::optional<Pose2> KeepOut::first_hit(const Motion& motion, double step_m) const {
  if (!hits_along(motion)) return std::nullopt;
  const auto pieces = [](double whole, double step) {
    return std::max(1, static_cast<int>(std::ceil(std::abs(whole) / step)));
  };
  const auto first_of = [&](int count, const auto& pose_at) -> std::optional<Pose2> {
    for (int k = 0; k <= count; ++k) {
      const Pose2 pose = pose_at(static_cast<double>(k) / count);
      if (hits(pose)) return pose;
    }
    return std::nullopt;
  };
  const auto turn = [&](const Pose2& start, double turn_rad) {
    return first_of(pieces(turn_rad, rad_from_deg(0.5)), [&](double share) {
      return Pose2{start.x_m, start.y_m, wrapped_rad(start.yaw_rad + share * turn_rad)};
    });
  };
  if (auto pose = turn(motion.from, motion.first_turn_rad)) return pose;
  if (auto pose = first_of(pieces(motion.length_m, step_m),
                           [&](double share) { return motion.at(share * motion.length_m); }))
    return pose;
  const Pose2 arrival{motion.to.x_m, motion.to.y_m, motion.to.yaw_rad - motion.last_turn_rad};
  if (auto pose = turn(arrival, motion.last_turn_rad)) return pose;
  return motion.to;
}

std::string_view trespass_in_words(const PlanProblem& problem) {
  if (problem.keep_in.empty()) return "enter a keep-out";
  return problem.keep_out.empty() ? "leave a keep-in" : "enter a keep-out or leave a keep-in";
}

std::optional<Pose2> first_hit(const KeepOut& keep_out, std::span<const Motion> motions) {
  for (const Motion& motion : motions)
    if (const auto pose = keep_out.first_hit(motion)) return pose;
  return std::nullopt;
}

}  // namespace slipway::planner
