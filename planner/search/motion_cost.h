#pragma once

#include <optional>
#include <vector>

#include "planner/problem/motion.h"
#include "planner/problem/problem.h"
#include "planner/search/ground_tables.h"
#include "planner/search/traverse_map.h"

namespace slipway::planner {

// What the search minimises: the cost catalogue's sum, for one set of weights, with the figures of each metre
// taken from the slip tables at a pose's pitch and roll on the cell's plane (see Metre). With a `tail` a
// metre costs what it does in the mean of the dearest `tail` share of the soils that its ground may have,
// with 1 in the mean of all of them; without one, and where the tables have no such soils, what
// expected_metre() says. A CVaR that is summed along a way is an upper bound of the route's own, which it
// reaches where all cells turn out weak together: CVaR is subadditive [Rockafellar & Uryasev 2000].
//
// The sum rises steeply from 3/4 of a limit (slip, current, sinkage, tilt) on. Off the map, near missing
// elevation, beyond the tilt limit, with too little clearance, in a keep-out and where the mean soil's rover
// is immobilised no motion is valid, and its cost is infinite.
class MotionCost {
 public:
  MotionCost(const PlanProblem& problem, const TraverseMap& map, const GroundTables& tables,
             const Weights& weights, std::optional<double> tail = std::nullopt);

  const TraverseMap& map() const { return *map_; }
  const MotionLimits& limits() const { return limits_; }

  // Per metre driven; infinite where the pose is not allowed.
  double per_metre(const Pose2& pose) const;
  // The same in a cell, in the direction (c, s), without regard to the cell's passage.
  double per_metre_in_cell(std::size_t cell, double c, double s) const;
  // The same on ground of a soil with this gradient, without a penalty.
  double per_metre_on(std::uint8_t soil, const Eigen::Vector2d& gradient, double c, double s) const {
    return on_slope(soil, c * gradient.x() + s * gradient.y(), -s * gradient.x() + c * gradient.y());
  }
  // No metre on any ground costs less, in any direction.
  double least_per_metre() const { return least_per_metre_; }
  // Midpoint rule over steps of at most `step_m` (0: a search cell). Infinite where the body meets a keep-out
  // anywhere along the motion, which is exact whatever the step.
  double of(const Motion& motion, double step_m = 0.0) const;
  double of_turn(double turned_rad) const;
  // What a bend of a polyline is taken to cost before it is rounded: a turn, with the pause coming in
  // gradually.
  double of_bend(double turned_rad) const;

  // Makes each metre in a cell cost (1 + factor[cell]) times as much; empty takes it back.
  void penalise(std::vector<float> factor) { penalty_ = std::move(factor); }
  // The same cost on another map of the problem, without a penalty.
  MotionCost on(const TraverseMap& map) const;

 private:
  double on_slope(std::uint8_t soil, double uphill, double leftward_rise) const;
  // Keep-outs near by are not asked.
  double per_metre_at(const Eigen::Vector2d& place, const Eigen::Vector2d& heading) const;
  void tabulate(const PlanProblem& problem, const GroundTable& table, bool unknown, const Weights& weights);
  void set_turn_cost(const GroundTables& tables, const Weights& weights);

  const TraverseMap* map_;
  std::optional<double> tail_;
  MotionLimits limits_;
  double turn_cost_per_rad_, turn_cost_each_;
  // Over rise per metre ahead and to the left, not over angles: a look-up then needs no trigonometry.
  double limit_ = 0.0;
  double nodes_per_unit_ = 0.0;
  int nodes_ = 0;  // per axis
  std::vector<float>
      per_slope_;  // ground kind, rise ahead, rise to the left; the last kind is unknown ground
  std::size_t kinds_ = 0;
  double least_per_metre_ = 0.0;
  std::vector<float> penalty_;
};

}  // namespace slipway::planner
