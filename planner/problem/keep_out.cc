#include "planner/problem/keep_out.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace slipway::planner {
namespace {

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

double distance_to_segment_m(const Eigen::Vector2d& p, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  const Eigen::Vector2d along = b - a;
  const double squared = along.squaredNorm();
  const double t = squared > 0.0 ? std::clamp((p - a).dot(along) / squared, 0.0, 1.0) : 0.0;
  return (p - a - t * along).norm();
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

}  // namespace

KeepOut::KeepOut(std::span<const Polygon> polygons, const sim::RoverModel& rover)
    : polygons_(polygons.begin(), polygons.end()),
      half_length_m_(0.5 * rover.body_length_m),
      half_width_m_(0.5 * rover.body_width_m),
      inscribed_m_(std::min(half_length_m_, half_width_m_)),
      circumscribed_m_(std::hypot(half_length_m_, half_width_m_)) {}

bool KeepOut::hits(const Pose2& pose) const {
  const Eigen::Vector2d p(pose.x_m, pose.y_m);
  const double c = std::cos(pose.yaw_rad);
  const double s = std::sin(pose.yaw_rad);
  const Eigen::Vector2d half(half_length_m_, half_width_m_);
  const auto in_body = [&](const Eigen::Vector2d& q) {
    const Eigen::Vector2d d = q - p;
    return Eigen::Vector2d(c * d.x() + s * d.y(), -s * d.x() + c * d.y());
  };
  return std::any_of(polygons_.begin(), polygons_.end(), [&](const Polygon& polygon) {
    if (inside(polygon, p)) return true;
    for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
      if (meets_box(in_body(polygon[j]), in_body(polygon[i]), half)) return true;
    }
    return false;
  });
}

double KeepOut::distance_m(double x_m, double y_m) const {
  const Eigen::Vector2d p(x_m, y_m);
  double least = std::numeric_limits<double>::infinity();
  for (const Polygon& polygon : polygons_) {
    if (inside(polygon, p)) return 0.0;
    for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
      least = std::min(least, distance_to_segment_m(p, polygon[j], polygon[i]));
    }
  }
  return least;
}

}  // namespace slipway::planner
