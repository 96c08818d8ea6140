#include "planner/judge/route_commands.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "core/angle.h"

namespace slipway::planner {
namespace {

constexpr double kNoLength_m = 1e-9;
constexpr double kLeastTurn_rad = rad_from_deg(0.5);
constexpr double kLeastDrive_m = 0.2;
// Between two arcs a straight this short moves the second one by no more than this.
constexpr double kLeastJoint_m = 0.05;
constexpr double kLongestDrive_m = 1000.0;
// How far off its end a straight may come out before the rover is turned towards it: on the way, and at the
// goal.
constexpr double kOnTheWay_m = 0.25, kAtTheGoal_m = 0.03;
constexpr double kHeadingError_rad = rad_from_deg(0.15);

// One drive of the route, with the turn in place before it.
struct Leg {
  double turn_rad = 0.0;
  double departure_rad = 0.0;
  double length_m = 0.0;
  double curvature_1_m = 0.0;
  Pose2 end;
  std::optional<double> stop_yaw;  // the heading that is asked for at a place on the way
  bool turns = false;              // the rover is turned before it

  bool is_straight() const { return curvature_1_m == 0.0; }
};

double hundredths(double value) {
  return std::round(100.0 * value) / 100.0;
}

// An angle to tenths of a degree, or finer where half a tenth over the drive that follows is too much.
double commanded_rad(double rad, double then_driven_m) {
  double parts = 10.0;
  while (parts < 1e4 && rad_from_deg(0.5 / parts) * then_driven_m > kAtTheGoal_m) parts *= 10.0;
  return rad_from_deg(std::round(deg_from_rad(rad) * parts) / parts);
}

// What is asked for, so that its degrees in a document read back as the same double.
double as_asked_rad(double rad) {
  constexpr double kParts = 1e9;
  return rad_from_deg(std::round(deg_from_rad(wrapped_rad(rad)) * kParts) / kParts);
}

bool is_place(const Waypoint& waypoint, const Pose2& pose) {
  constexpr double kSame_m = 1e-6;
  return std::hypot(waypoint.x_m - pose.x_m, waypoint.y_m - pose.y_m) < kSame_m;
}

std::vector<Leg> legs_of(const PlanProblem& problem, const std::vector<Motion>& motions) {
  std::vector<Leg> legs;
  double turn = 0.0;
  for (const Motion& motion : motions) {
    turn += motion.first_turn_rad;
    if (motion.length_m > kNoLength_m) {
      Leg leg{.turn_rad = turn,
              .departure_rad = motion.departure_rad(),
              .length_m = motion.length_m,
              .curvature_1_m = motion.curvature_1_m,
              .end = motion.at(motion.length_m),
              .stop_yaw = {}};
      // An arc that turns by next to nothing is a straight with an end of its own.
      if (std::abs(leg.curvature_1_m) * leg.length_m < 0.5 * kLeastTurn_rad) leg.curvature_1_m = 0.0;
      for (const Waypoint& place : problem.waypoints)
        if (place.yaw_rad && is_place(place, motion.to)) leg.stop_yaw = place.yaw_rad;
      legs.push_back(leg);
      turn = 0.0;
    }
    turn += motion.last_turn_rad;
  }
  return legs;
}

// Whether the leg's neighbours can take it over: it is short, or goes on where the one before it went.
bool is_left_out(const std::vector<Leg>& legs, std::size_t i) {
  const Leg& leg = legs[i];
  const bool is_last = i + 1 == legs.size();
  if (leg.stop_yaw || (is_last && i == 0)) return false;
  if (!leg.is_straight()) return leg.length_m < kLeastDrive_m;
  const bool turned = std::abs(leg.turn_rad) >= kLeastTurn_rad;
  if (is_last) return turned && leg.length_m < kLeastDrive_m && !legs[i - 1].stop_yaw;
  const Leg& next = legs[i + 1];
  const bool next_turned = std::abs(next.turn_rad) >= kLeastTurn_rad;
  if (next.is_straight() && !next_turned) return true;
  return leg.length_m < (turned || next_turned || i == 0 ? kLeastDrive_m : kLeastJoint_m);
}

// Gives the short legs to their neighbours and joins straights that go on as one.
void merge(std::vector<Leg>& legs) {
  for (std::size_t i = 0; i < legs.size();) {
    if (!is_left_out(legs, i)) {
      ++i;
      continue;
    }
    if (i + 1 < legs.size())
      legs[i + 1].turn_rad += legs[i].turn_rad + legs[i].curvature_1_m * legs[i].length_m;
    else
      legs[i - 1].end = legs[i].end;
    legs.erase(legs.begin() + static_cast<std::ptrdiff_t>(i));
    if (i > 0) --i;
  }
  for (Leg& leg : legs) leg.turns = std::abs(leg.turn_rad) >= kLeastTurn_rad;
}

// Commands a route's legs one by one, each from where the ones before it lead.
class Commander {
 public:
  Commander(const PlanProblem& problem, std::vector<Leg> legs, const Pose2& start)
      : problem_(problem),
        legs_(std::move(legs)),
        least_radius_m_(std::ceil(100.0 * problem.rover->min_turn_radius_m - 1e-6) / 100.0),
        free_start_(!problem.start.yaw_rad) {
    out_.start = start;
    if (!free_start_) out_.start.yaw_rad = as_asked_rad(*problem.start.yaw_rad);
    at_ = out_.start;
  }

  DriveSteps run() {
    for (std::size_t i = 0; i < legs_.size(); ++i) {
      if (legs_[i].is_straight())
        drive_straight(i);
      else
        drive_arc(i);
      free_start_ = false;
      if (legs_[i].stop_yaw) face(*legs_[i].stop_yaw);
    }
    if (problem_.goal.yaw_rad) face(*problem_.goal.yaw_rad);
    return std::move(out_);
  }

 private:
  void command(const DriveStep& step) {
    out_.steps.push_back(step);
    at_ = command_motion(at_, step).to;
  }

  void turn(double turn_rad, double then_driven_m) {
    if (free_start_) {
      out_.start.yaw_rad = wrapped_rad(commanded_rad(wrapped_rad(at_.yaw_rad + turn_rad), then_driven_m));
      at_ = out_.start;
      return;
    }
    const double rounded = commanded_rad(turn_rad, then_driven_m);
    if (rounded != 0.0) command({.turn_rad = rounded});
  }

  // Stands in the heading that is asked for.
  void face(double yaw_rad) {
    const double off = wrapped_rad(yaw_rad - at_.yaw_rad);
    if (std::abs(off) > kHeadingError_rad) turn(off, 0.0);
  }

  void drive_straight(std::size_t i) {
    const Leg& leg = legs_[i];
    const double dx = leg.end.x_m - at_.x_m, dy = leg.end.y_m - at_.y_m;
    const double away = std::hypot(dx, dy), off = wrapped_rad(std::atan2(dy, dx) - at_.yaw_rad);
    const double allowed = i + 1 == legs_.size() ? kAtTheGoal_m : kOnTheWay_m;
    if (free_start_ || leg.turns || std::cos(off) <= 0.0 || away * std::abs(std::sin(off)) > allowed)
      turn(off, away);
    double left = hundredths(dx * std::cos(at_.yaw_rad) + dy * std::sin(at_.yaw_rad));
    for (; left > kLongestDrive_m; left = hundredths(left - kLongestDrive_m))
      command({.drive_m = kLongestDrive_m});
    if (left > 0.0) command({.drive_m = left});
  }

  void drive_arc(std::size_t i) {
    const Leg& leg = legs_[i];
    if (free_start_ || leg.turns) turn(wrapped_rad(leg.departure_rad - at_.yaw_rad), 0.0);
    command(fitted_arc(i));
  }

  // What an arc misses, squared: the end of what is driven next without a turn, or its own end.
  double missed(std::size_t i, const DriveStep& arc) const {
    const Leg& leg = legs_[i];
    const Pose2 reached = command_motion(at_, arc).to;
    const double off_x = reached.x_m - leg.end.x_m, off_y = reached.y_m - leg.end.y_m;
    const double off = off_x * off_x + off_y * off_y;
    constexpr double kOwnEnd = 0.01;  // of the weight of the next one's
    if (i + 1 < legs_.size() && !legs_[i + 1].turns && !leg.stop_yaw) {
      const Leg& next = legs_[i + 1];
      Motion on{
          .from = reached, .to = reached, .length_m = next.length_m, .curvature_1_m = next.curvature_1_m};
      const Pose2 then = next.is_straight() ? reached : on.at(on.length_m);
      const double aside = (next.end.y_m - then.y_m) * std::cos(then.yaw_rad) -
                           (next.end.x_m - then.x_m) * std::sin(then.yaw_rad);
      return aside * aside + kOwnEnd * off;
    }
    if (i + 1 < legs_.size() || !problem_.goal.yaw_rad) return off;
    // An arc that arrives in the heading that is asked for: 5 cm weigh what 0.2 deg weigh.
    constexpr double kArm_m = 0.05 / rad_from_deg(0.2);
    const double turned = wrapped_rad(reached.yaw_rad - *problem_.goal.yaw_rad);
    const bool arrives = std::abs(wrapped_rad(leg.end.yaw_rad - *problem_.goal.yaw_rad)) < kLeastTurn_rad;
    return off + (arrives ? std::pow(kArm_m * turned, 2) : 0.0);
  }

  // The best length with a radius, to a centimetre.
  std::pair<double, DriveStep> best_length(std::size_t i, double radius_m) const {
    constexpr double kGolden = 0.6180339887498949;
    const auto miss = [&](double length_m) { return missed(i, {.drive_m = length_m, .radius_m = radius_m}); };
    double low = 0.8 * legs_[i].length_m, high = 1.2 * legs_[i].length_m;
    while (high - low > 0.005) {
      const double a = high - kGolden * (high - low), b = low + kGolden * (high - low);
      (miss(a) < miss(b) ? high : low) = miss(a) < miss(b) ? b : a;
    }
    std::pair<double, DriveStep> best{std::numeric_limits<double>::infinity(), {}};
    for (const double length : {hundredths(low) - 0.01, hundredths(low), hundredths(low) + 0.01}) {
      const double rounded = std::max(0.01, hundredths(length));
      if (const double off = miss(rounded); off < best.first)
        best = {off, {.drive_m = rounded, .radius_m = radius_m}};
    }
    return best;
  }

  // The arc that misses least: of radii within a tenth of the planned one, then of those near the best.
  DriveStep fitted_arc(std::size_t i) const {
    constexpr int kTried = 20;
    const double side = std::copysign(1.0, legs_[i].curvature_1_m);
    std::pair<double, DriveStep> best{std::numeric_limits<double>::infinity(), {}};
    double about_m = std::max(least_radius_m_, 1.0 / std::abs(legs_[i].curvature_1_m));
    for (const double reach : {0.1, 0.01}) {
      const double centre_m = about_m, step_m = std::max(0.01, reach * centre_m / kTried);
      for (int k = -kTried; k <= kTried; ++k) {
        const double radius = std::max(least_radius_m_, hundredths(centre_m + k * step_m));
        const auto found = best_length(i, side * radius);
        if (!(found.first < best.first)) continue;
        best = found;
        about_m = radius;
      }
    }
    return best.second;
  }

  const PlanProblem& problem_;
  std::vector<Leg> legs_;
  double least_radius_m_;
  bool free_start_;  // the start's heading is still to be chosen
  Pose2 at_;
  DriveSteps out_;
};

}  // namespace

DriveSteps route_commands(const PlanProblem& problem, const std::vector<Motion>& motions) {
  std::vector<Leg> legs = legs_of(problem, motions);
  merge(legs);
  Pose2 start = motions.front().from;
  start.yaw_rad = wrapped_rad(start.yaw_rad);
  return Commander(problem, std::move(legs), start).run();
}

}  // namespace slipway::planner
