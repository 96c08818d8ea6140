#include "planner/search/grid_leg_planner.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace slipway::planner {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// How many cells one straight may leave out.
constexpr std::size_t kFurthest = 40;

// The cheapest known way to a place: its cost, the heading it arrives with, and the place it comes from.
struct Arrival {
  double cost = kInfinity;
  Pose2 pose;
  std::size_t before = 0;
};

void take_if_cheaper(const MotionCost& cost, const std::vector<Arrival>& reached, std::size_t from,
                     const Motion& motion, Arrival& at) {
  const double sum = reached[from].cost + cost.of(motion);
  if (sum < at.cost) at = {sum, motion.to, from};
}

std::vector<Pose2> poses_to(const std::vector<Arrival>& reached) {
  if (!(reached.back().cost < kInfinity)) return {};
  std::vector<Pose2> poses;
  for (std::size_t k = reached.size() - 1; k > 0; k = reached[k].before) poses.push_back(reached[k].pose);
  poses.push_back(reached.front().pose);
  std::reverse(poses.begin(), poses.end());
  return poses;
}

class GridPlanner final : public LegPlanner {
 public:
  std::vector<Pose2> search(const LegSearch& leg) const override {
    return pull_straight(*leg.cost, leg.from, places_along(leg), leg.arrival_rad, leg.cancelled);
  }
};

}  // namespace

std::vector<Eigen::Vector2d> places_along(const LegSearch& leg) {
  const std::vector<std::size_t>& cells = leg.sampler->way();
  std::vector<Eigen::Vector2d> places;
  if (cells.empty()) return places;
  // The way's ends are in the first and last cell, mostly not at their centres.
  places.emplace_back(leg.from.x_m, leg.from.y_m);
  for (std::size_t k = 1; k + 1 < cells.size(); ++k) places.push_back(leg.cost->map().centre_m(cells[k]));
  places.emplace_back(leg.to_x_m, leg.to_y_m);
  return places;
}

std::vector<Pose2> pull_straight(const MotionCost& cost, const Pose2& from,
                                 const std::vector<Eigen::Vector2d>& places,
                                 const std::vector<double>& arrival_rad,
                                 const std::function<bool()>& cancelled) {
  if (places.empty()) return {};
  std::vector<Arrival> reached(places.size());
  reached.front() = {0.0, from, 0};
  for (std::size_t to = 1; to < places.size(); ++to) {
    if (cancelled && cancelled()) return {};
    for (std::size_t before = to - std::min(to, kFurthest); before < to; ++before) {
      if (!(reached[before].cost < kInfinity)) continue;
      const Pose2& start = reached[before].pose;
      if (to + 1 < places.size()) {
        take_if_cheaper(cost, reached, before, straight(start, places[to].x(), places[to].y()), reached[to]);
        continue;
      }
      for (const double heading : arrival_rad)
        take_if_cheaper(cost, reached, before,
                        connect(start, {places[to].x(), places[to].y(), heading}, cost.limits()),
                        reached[to]);
    }
  }
  return poses_to(reached);
}

std::unique_ptr<LegPlanner> make_grid_planner() {
  return std::make_unique<GridPlanner>();
}

}  // namespace slipway::planner
