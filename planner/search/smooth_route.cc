#include "planner/search/smooth_route.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/angle.h"

namespace slipway::planner {
namespace {

using Corners = std::vector<Eigen::Vector2d>;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kMaxSide_m = 8.0;
constexpr double kSameCorner_m = 1e-3;
constexpr double kSameHeading_rad = 1e-6;
constexpr int kSweeps = 24;
constexpr std::array<double, 6> kMoves_m{2.0, -2.0, 1.0, -1.0, 0.4, -0.4};
constexpr std::array<double, 10> kRadii_m{400.0, 150.0, 80.0, 40.0, 25.0, 15.0, 10.0, 6.0, 4.0, 2.5};
constexpr double kLeastArc_m = 0.2;  // that a rover is commanded
constexpr double kGain = 1e-9;       // cheaper by less is not cheaper
// A jog to one side and back over less than this is left out where what it gains is a smaller share of the
// cost about it: the search's cost of a turn in place knows nothing of a drive's draws.
constexpr double kJog_m = 1.0;
constexpr double kJogGain = 0.03;

double bearing_rad(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return std::atan2(b.y() - a.y(), b.x() - a.x());
}

// A polyline that starts at a pose, judged as straights and bends.
class Polyline {
 public:
  Polyline(const MotionCost& cost, double first_heading_rad, Corners corners)
      : cost_(cost), first_heading_rad_(first_heading_rad), corners_(std::move(corners)) {}

  const Corners& corners() const { return corners_; }

  // One sweep over the inner corners; true where something got cheaper.
  bool sweep() {
    bool better = false;
    for (std::size_t i = 1; i + 1 < corners_.size(); ++i) better |= improve(i);
    return better;
  }

  // Leaves out corners that a straight past them makes cheaper.
  void leave_out() {
    for (std::size_t i = 1; i + 1 < corners_.size();) {
      const double with = around(i, corners_[i]);
      const double without = side(corners_[i - 1], corners_[i + 1]) + bends_without(i);
      if (without <= with + kGain) {
        corners_.erase(corners_.begin() + static_cast<std::ptrdiff_t>(i));
      } else {
        ++i;
      }
    }
  }

  // Draws the two corners of a short jog together to one.
  void leave_out_jogs() {
    for (std::size_t i = 1; i + 2 < corners_.size();) {
      if (is_jog(i) && leaves_jog(i))
        i = std::max<std::size_t>(1, i - 1);
      else
        ++i;
    }
  }

 private:
  // Corners i and i + 1 turn to opposite sides, and it is not far from one to the other.
  bool is_jog(std::size_t i) const {
    if ((corners_[i + 1] - corners_[i]).norm() >= kJog_m) return false;
    const double between = bearing_rad(corners_[i], corners_[i + 1]);
    const double first = wrapped_rad(between - bearing_rad(corners_[i - 1], corners_[i]));
    const double second = wrapped_rad(bearing_rad(corners_[i + 1], corners_[i + 2]) - between);
    return first * second < 0.0;
  }

  // From the corner before i over the given places to the corner after `last`, with the bends at both ends.
  double stretch(std::size_t i, std::size_t last, const Corners& places) const {
    Corners line{corners_[i - 1]};
    line.insert(line.end(), places.begin(), places.end());
    line.push_back(corners_[last + 1]);
    double heading = heading_before(i - 1), sum = 0.0;
    for (std::size_t k = 1; k < line.size(); ++k) {
      const double leaving = bearing_rad(line[k - 1], line[k]);
      sum += bend(heading, leaving) + side(line[k - 1], line[k]);
      heading = leaving;
    }
    if (last + 2 < corners_.size()) sum += bend(heading, bearing_rad(corners_[last + 1], corners_[last + 2]));
    return sum;
  }

  bool leaves_jog(std::size_t i) {
    const double most = (1.0 + kJogGain) * stretch(i, i + 1, {corners_[i], corners_[i + 1]});
    const Eigen::Vector2d middle = 0.5 * (corners_[i] + corners_[i + 1]);
    const std::array<Corners, 4> others{{{}, {middle}, {corners_[i]}, {corners_[i + 1]}}};
    for (const Corners& places : others) {
      if (!(stretch(i, i + 1, places) <= most)) continue;
      const auto at = corners_.begin() + static_cast<std::ptrdiff_t>(i);
      corners_.insert(corners_.erase(at, at + 2), places.begin(), places.end());
      return true;
    }
    return false;
  }

  double side(const Eigen::Vector2d& a, const Eigen::Vector2d& b) const {
    const double bearing = bearing_rad(a, b);
    return cost_.of(straight({a.x(), a.y(), bearing}, b.x(), b.y()));
  }

  double bend(double arriving, double leaving) const {
    return cost_.of_bend(wrapped_rad(leaving - arriving));
  }

  double heading_before(std::size_t i) const {
    return i == 0 ? first_heading_rad_ : bearing_rad(corners_[i - 1], corners_[i]);
  }

  double bends_without(std::size_t i) const {
    const double direct = bearing_rad(corners_[i - 1], corners_[i + 1]);
    double sum = bend(heading_before(i - 1), direct);
    if (i + 2 < corners_.size()) sum += bend(direct, bearing_rad(corners_[i + 1], corners_[i + 2]));
    return sum;
  }

  // What changes with corner i: its two sides and the bends at it and at its neighbours.
  double around(std::size_t i, const Eigen::Vector2d& place) const {
    const double in = bearing_rad(corners_[i - 1], place);
    const double out = bearing_rad(place, corners_[i + 1]);
    double sum = bend(heading_before(i - 1), in) + bend(in, out);
    if (i + 2 < corners_.size()) sum += bend(out, bearing_rad(corners_[i + 1], corners_[i + 2]));
    return sum + side(corners_[i - 1], place) + side(place, corners_[i + 1]);
  }

  bool improve(std::size_t i) {
    const Eigen::Vector2d along = (corners_[i + 1] - corners_[i - 1]).normalized();
    const Eigen::Vector2d across(-along.y(), along.x());
    const Eigen::Vector2d place = corners_[i];
    double least = around(i, place);
    bool better = false;
    for (const double move : kMoves_m) {
      const Eigen::Vector2d tried = place + move * across;
      const double sum = around(i, tried);
      if (sum < least - kGain) {
        least = sum;
        corners_[i] = tried;
        better = true;
      }
    }
    return better;
  }

  const MotionCost& cost_;
  double first_heading_rad_;
  Corners corners_;
};

// Straights joined by turns in place; the last corner is the leg's end.
std::vector<Motion> straights(const Pose2& from, const Corners& corners) {
  std::vector<Motion> motions;
  Pose2 at = from;
  for (std::size_t i = 1; i < corners.size(); ++i) {
    motions.push_back(straight(at, corners[i].x(), corners[i].y()));
    at = motions.back().to;
  }
  return motions;
}

std::vector<Motion> round_corners(const MotionCost& cost, std::vector<Motion> motions) {
  const MotionLimits& limits = cost.limits();
  const double fine = 0.5 * cost.map().cell_m();
  for (std::size_t i = 1; i < motions.size(); ++i) {
    const double turn = std::abs(motions[i].first_turn_rad);
    if (turn < 1e-6 || turn > rad_from_deg(100.0)) continue;
    // The next corner wants a share of the straight that follows this one.
    Motion in = motions[i - 1];
    const bool more_corners = i + 1 < motions.size();
    double least = cost.of(in, fine) + cost.of(motions[i], fine) - kGain;
    std::vector<Motion> best;
    for (const double radius : kRadii_m) {
      const double cut = radius * std::tan(0.5 * turn);
      if (radius < limits.min_turn_radius_m || radius * turn < kLeastArc_m ||
          (more_corners && cut > 0.5 * motions[i].length_m))
        continue;
      std::vector<Motion> tried = round_corner(in, motions[i], radius);
      double sum = 0.0;
      for (const Motion& motion : tried) sum += cost.of(motion, fine);
      if (!tried.empty() && sum < least) {
        least = sum;
        best = std::move(tried);
      }
    }
    if (best.empty()) continue;
    motions[i - 1] = best[0];
    motions[i] = best[2];
    motions.insert(motions.begin() + static_cast<std::ptrdiff_t>(i), best[1]);
    ++i;
  }
  return motions;
}

// The end in its heading: as an arc where that is cheaper than a last turn in place.
void arrive(const MotionCost& cost, std::vector<Motion>& motions, double heading_rad) {
  Motion& last = motions.back();
  Motion turned = last;
  turned.last_turn_rad = wrapped_rad(heading_rad - last.to.yaw_rad);
  turned.to.yaw_rad = heading_rad;
  const Motion arc = connect(last.from, turned.to, cost.limits());
  last = cost.of(arc) < cost.of(turned) - kGain ? arc : turned;
}

std::vector<Motion> chain(const MotionCost& cost, const std::vector<Pose2>& poses) {
  std::vector<Motion> motions;
  for (std::size_t i = 1; i < poses.size(); ++i)
    motions.push_back(connect(poses[i - 1], poses[i], cost.limits()));
  return motions;
}

// From each pose directly to the furthest pose that is not dearer to reach so.
std::vector<Pose2> shortcut(const MotionCost& cost, const std::vector<Pose2>& poses) {
  constexpr std::size_t kFurthest = 10;
  std::vector<double> so_far{0.0};
  for (const Motion& motion : chain(cost, poses)) so_far.push_back(so_far.back() + cost.of(motion));
  std::vector<Pose2> kept{poses.front()};
  for (std::size_t i = 0; i + 1 < poses.size();) {
    std::size_t next = i + 1;
    for (std::size_t j = std::min(i + kFurthest, poses.size() - 1); j > i + 1; --j) {
      if (cost.of(connect(poses[i], poses[j], cost.limits())) <= so_far[j] - so_far[i]) {
        next = j;
        break;
      }
    }
    kept.push_back(poses[next]);
    i = next;
  }
  return kept;
}

// How many turns in place there are.
std::size_t turns_of(const std::vector<Motion>& motions) {
  std::size_t turns = 0;
  for (const Motion& motion : motions) {
    turns += std::abs(motion.first_turn_rad) > kSameHeading_rad ? 1U : 0U;
    turns += std::abs(motion.last_turn_rad) > kSameHeading_rad ? 1U : 0U;
  }
  return turns;
}

// A polyline close to the motions: their ends, and places on the way along arcs.
Corners corners_along(const std::vector<Motion>& motions) {
  Corners corners;
  for (const Motion& motion : motions) {
    if (corners.empty()) corners.emplace_back(motion.from.x_m, motion.from.y_m);
    const double longest = motion.curvature_1_m == 0.0 ? kMaxSide_m : 0.5 * kMaxSide_m;
    const int parts = static_cast<int>(std::ceil(motion.length_m / longest));
    for (int k = 1; k <= parts; ++k) {
      const Pose2 pose = motion.at(motion.length_m * k / parts);
      const Eigen::Vector2d place(pose.x_m, pose.y_m);
      if ((place - corners.back()).norm() > kSameCorner_m) corners.push_back(place);
    }
  }
  return corners;
}

}  // namespace

std::vector<Motion> round_corner(const Motion& in, const Motion& out, double radius_m) {
  const double cut = radius_m * std::tan(0.5 * std::abs(out.first_turn_rad));
  if (cut >= in.length_m || cut >= out.length_m) return {};
  Motion before = in;
  before.length_m -= cut;
  before.to = before.at(before.length_m);
  const Pose2 behind{out.from.x_m + cut * std::cos(out.to.yaw_rad),
                     out.from.y_m + cut * std::sin(out.to.yaw_rad), out.to.yaw_rad};
  Motion after = straight(behind, out.to.x_m, out.to.y_m);
  after.first_turn_rad = 0.0;
  after.to = out.to;
  // Not by connect(): an arc of the least radius is too tight for it by a rounding error, and its turns in
  // place, which a tangent arc has none of, are no part of the route.
  Motion arc{.from = before.to, .to = behind};
  arc.curvature_1_m = std::copysign(1.0 / radius_m, out.first_turn_rad);
  arc.length_m = radius_m * std::abs(out.first_turn_rad);
  return {before, arc, after};
}

double fine_cost(const MotionCost& cost, const std::vector<Motion>& motions) {
  double sum = 0.0;
  for (const Motion& motion : motions) sum += cost.of(motion, 0.5 * cost.map().cell_m());
  return sum;
}

std::vector<Motion> smooth_leg(const MotionCost& cost, const std::vector<Pose2>& poses,
                               bool keep_last_heading, const std::function<bool()>& cancelled) {
  const std::vector<Pose2> kept = shortcut(cost, poses);
  std::vector<Motion> arcs = chain(cost, kept);
  if (!keep_last_heading && !arcs.empty()) {
    arcs.back().to.yaw_rad = wrapped_rad(arcs.back().to.yaw_rad - arcs.back().last_turn_rad);
    arcs.back().last_turn_rad = 0.0;
  }
  Corners corners = corners_along(arcs);
  if (corners.size() < 2) return arcs;
  corners.back() = {poses.back().x_m, poses.back().y_m};
  Polyline line(cost, poses.front().yaw_rad, std::move(corners));
  const auto sweep = [&] {
    for (int k = 0; k < kSweeps && !(cancelled && cancelled()) && line.sweep(); ++k) {
    }
  };
  sweep();
  line.leave_out();
  sweep();
  line.leave_out();
  line.leave_out_jogs();
  std::vector<Motion> motions = round_corners(cost, straights(poses.front(), line.corners()));
  if (keep_last_heading) arrive(cost, motions, poses.back().yaw_rad);
  const double smooth = fine_cost(cost, motions);
  const double found = fine_cost(cost, arcs);
  const bool calmer = turns_of(motions) < turns_of(arcs);
  if (smooth < kInfinity && smooth <= (calmer ? 1.0 + kJogGain : 1.0) * found) return motions;
  return arcs;
}

}  // namespace slipway::planner
