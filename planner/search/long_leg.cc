#include "planner/search/long_leg.h"

#include <algorithm>
#include <cmath>

#include "core/angle.h"
#include "planner/search/grid_leg_planner.h"
#include "planner/search/smooth_route.h"

namespace slipway::planner {
namespace {

constexpr double kPiece_m = 200.0;

template <class Length>
std::size_t end_of_piece(std::size_t begin, std::size_t places, const Length& length_before) {
  std::size_t end = begin + 1;
  for (double driven = 0.0; end + 1 < places && driven < kPiece_m; ++end) driven += length_before(end);
  return end;
}

// Motions as they are, and those that would do better.
void take_cheaper(const MotionCost& cost, std::vector<Motion> other, std::vector<Motion>& motions) {
  if (!other.empty() && fine_cost(cost, other) < fine_cost(cost, motions)) motions = std::move(other);
}

std::vector<Motion> cell_by_cell(const Pose2& from, const std::vector<Eigen::Vector2d>& way) {
  std::vector<Motion> motions;
  Pose2 at = from;
  for (std::size_t k = 1; k < way.size(); ++k) {
    motions.push_back(straight(at, way[k].x(), way[k].y()));
    at = motions.back().to;
  }
  return motions;
}

std::vector<Pose2> ends_of(const std::vector<Motion>& motions) {
  std::vector<Pose2> poses{motions.front().from};
  for (const Motion& motion : motions) poses.push_back(motion.to);
  return poses;
}

// Smooths each joint with half of the pieces on both sides of it.
void smooth_joints(const MotionCost& cost, std::vector<std::vector<Motion>>& pieces) {
  for (std::size_t k = 1; k < pieces.size(); ++k) {
    std::vector<Motion>&before = pieces[k - 1], &after = pieces[k];
    const auto tail = static_cast<std::ptrdiff_t>(before.size() / 2);
    const auto head = static_cast<std::ptrdiff_t>((after.size() + 1) / 2);
    std::vector<Motion> around(before.begin() + tail, before.end());
    around.insert(around.end(), after.begin(), after.begin() + head);
    if (around.size() < 2) continue;
    const std::vector<Motion> smoothed = smooth_leg(cost, ends_of(around), true);
    if (!(fine_cost(cost, smoothed) < fine_cost(cost, around))) continue;
    before.erase(before.begin() + tail, before.end());
    before.insert(before.end(), smoothed.begin(), smoothed.end());
    after.erase(after.begin(), after.begin() + head);
    if (after.empty()) {
      // Its end is the joint of the next two.
      after.swap(before);
      pieces.erase(pieces.begin() + static_cast<std::ptrdiff_t>(--k));
    }
  }
}

std::vector<Motion> joined(const std::vector<std::vector<Motion>>& pieces) {
  std::vector<Motion> motions;
  for (const std::vector<Motion>& piece : pieces) motions.insert(motions.end(), piece.begin(), piece.end());
  return motions;
}

}  // namespace

std::size_t piece_end(const std::vector<Eigen::Vector2d>& way, std::size_t begin) {
  return end_of_piece(begin, way.size(), [&](std::size_t k) { return (way[k] - way[k - 1]).norm(); });
}

std::vector<Motion> drive_long_way(const LegSearch& leg) {
  const std::vector<Eigen::Vector2d> way = places_along(leg);
  std::vector<std::vector<Motion>> pieces;
  Pose2 at = leg.from;
  for (std::size_t begin = 0; begin + 1 < way.size();) {
    if (leg.cancelled && leg.cancelled()) return {};
    const std::size_t end = piece_end(way, begin);
    const bool is_last = end + 1 == way.size();
    const std::vector<Eigen::Vector2d> part(way.begin() + static_cast<std::ptrdiff_t>(begin),
                                            way.begin() + static_cast<std::ptrdiff_t>(end) + 1);
    const Eigen::Vector2d direct = part.back() - part.front();
    const std::vector<double> headings =
        is_last ? leg.arrival_rad : std::vector<double>{std::atan2(direct.y(), direct.x())};
    const bool keeps_heading = is_last && leg.arrival_rad.size() == 1;
    std::vector<Motion> motions = cell_by_cell(at, part);
    if (keeps_heading) {
      motions.back().last_turn_rad = wrapped_rad(leg.arrival_rad.front() - motions.back().to.yaw_rad);
      motions.back().to.yaw_rad = leg.arrival_rad.front();
    }
    const std::vector<Pose2> pulled = pull_straight(*leg.cost, at, part, headings, leg.cancelled);
    if (pulled.size() > 1)
      take_cheaper(*leg.cost, smooth_leg(*leg.cost, pulled, keeps_heading, leg.cancelled), motions);
    if (!std::isfinite(fine_cost(*leg.cost, motions))) return {};
    at = motions.back().to;
    pieces.push_back(std::move(motions));
    begin = end;
  }
  if (!(leg.cancelled && leg.cancelled())) smooth_joints(*leg.cost, pieces);
  return joined(pieces);
}

std::vector<Motion> smooth_long_leg(const MotionCost& cost, const std::vector<Pose2>& poses,
                                    bool keep_last_heading, const std::function<bool()>& cancelled) {
  std::vector<std::vector<Motion>> pieces;
  for (std::size_t begin = 0; begin + 1 < poses.size();) {
    if (cancelled && cancelled()) return {};
    const std::size_t end = end_of_piece(begin, poses.size(), [&](std::size_t k) {
      return std::hypot(poses[k].x_m - poses[k - 1].x_m, poses[k].y_m - poses[k - 1].y_m);
    });
    const std::vector<Pose2> part(poses.begin() + static_cast<std::ptrdiff_t>(begin),
                                  poses.begin() + static_cast<std::ptrdiff_t>(end) + 1);
    // The next piece begins in the heading that its poses have.
    pieces.push_back(smooth_leg(cost, part, keep_last_heading || end + 1 < poses.size(), cancelled));
    begin = end;
  }
  if (!(cancelled && cancelled())) smooth_joints(cost, pieces);
  return joined(pieces);
}

}  // namespace slipway::planner
