#include "planner/search/motion_cost.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "core/angle.h"
#include "planner/search/metre.h"

namespace slipway::planner {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kSlopeStep = 0.0175;  // a degree
constexpr double kSteepFrom = 0.75;    // of a limit
// A turn in place is not only its turning: the wheels are steered first and straightened after.
constexpr double kSteeringPause_s = 20.0;
constexpr double kFullPause_rad = rad_from_deg(30.0);
constexpr double kNoTurn_rad = rad_from_deg(0.5);

// 1 up to 3/4 of the limit, 11 at it, on with the parabola.
double steepness(double share_of_limit) {
  const double over = std::max(0.0, share_of_limit - kSteepFrom) / (1.0 - kSteepFrom);
  return 1.0 + 10.0 * over * over;
}

}  // namespace

MotionCost::MotionCost(const PlanProblem& problem, const TraverseMap& map, const GroundTables& tables,
                       const Weights& weights, std::optional<double> tail)
    : map_(&map), tail_(tail), limits_(motion_limits(*problem.rover)) {
  limit_ = std::tan(tables.unknown->mean.limit_rad());
  nodes_ = 2 * static_cast<int>(std::ceil(limit_ / kSlopeStep)) + 1;
  nodes_per_unit_ = (nodes_ - 1) / (2.0 * limit_);
  kinds_ = tables.known.size() + 1;
  per_slope_.reserve(kinds_ * static_cast<std::size_t>(nodes_) * static_cast<std::size_t>(nodes_));
  for (const std::optional<GroundTable>& table : tables.known) {
    if (table) {
      tabulate(problem, *table, false, weights);
    } else {
      per_slope_.insert(per_slope_.end(), static_cast<std::size_t>(nodes_) * static_cast<std::size_t>(nodes_),
                        std::numeric_limits<float>::infinity());
    }
  }
  tabulate(problem, *tables.unknown, true, weights);
  least_per_metre_ = *std::min_element(per_slope_.begin(), per_slope_.end());
  set_turn_cost(tables, weights);
}

MotionCost MotionCost::on(const TraverseMap& map) const {
  MotionCost cost = *this;
  cost.map_ = &map;
  cost.penalty_.clear();
  return cost;
}

// A turn in place draws what driving on the level draws, for as long as it takes.
void MotionCost::set_turn_cost(const GroundTables& tables, const Weights& weights) {
  const double level_w = tables.unknown->mean.at(0.0, 0.0)->energy_j_m * limits_.cruise_speed_m_s;
  const double seconds_per_rad = 1.0 / limits_.turn_rate_rad_s;
  turn_cost_per_rad_ =
      weights.cost({.turned_rad = 1.0, .duration_s = seconds_per_rad, .energy_j = level_w * seconds_per_rad});
  turn_cost_each_ = weights.cost({.duration_s = kSteeringPause_s});
}

void MotionCost::tabulate(const PlanProblem& problem, const GroundTable& table, bool unknown,
                          const Weights& weights) {
  const double limit_rad = std::min(table.mean.limit_rad(), table.weak.limit_rad());
  for (int i = 0; i < nodes_; ++i) {
    for (int j = 0; j < nodes_; ++j) {
      // R_MB = Rz(yaw) Ry(pitch) Rx(roll) on the plane: pitch is positive nose down, roll positive left side
      // up.
      const double uphill = -limit_ + i / nodes_per_unit_;
      const double leftward = -limit_ + j / nodes_per_unit_;
      const double pitch = std::clamp(-std::atan(uphill), -limit_rad, limit_rad);
      const double roll =
          std::clamp(std::asin(leftward / std::sqrt(1.0 + uphill * uphill + leftward * leftward)), -limit_rad,
                     limit_rad);
      const std::optional<Metre> metre = expected_metre(problem, table, unknown, pitch, roll);
      double cost = kInfinity;
      if (metre) {
        cost = tail_ && !table.likely.empty()
                   ? tail_cost_of_metre(problem, table, unknown, pitch, roll, weights, *tail_)
                   : weights.cost(metre->figures);
        cost *= steepness(metre->share_of_limits);
      }
      per_slope_.push_back(static_cast<float>(cost));
    }
  }
}

double MotionCost::on_slope(std::uint8_t soil, double uphill, double leftward_rise) const {
  const double row = (uphill + limit_) * nodes_per_unit_;
  const double column = (leftward_rise + limit_) * nodes_per_unit_;
  if (!(row >= 0.0 && column >= 0.0 && row <= nodes_ - 1 && column <= nodes_ - 1)) return kInfinity;
  const int i = std::min(static_cast<int>(row), nodes_ - 2);
  const int j = std::min(static_cast<int>(column), nodes_ - 2);
  const std::size_t kind = soil == kUnknownSoil ? kinds_ - 1 : soil;
  const auto nodes = static_cast<std::size_t>(nodes_);
  const float* corner = &per_slope_[(kind * nodes + static_cast<std::size_t>(i)) * nodes + j];
  const double t = column - j;
  const double u = row - i;
  const double sum = (1.0 - u) * ((1.0 - t) * corner[0] + t * corner[1]) +
                     u * ((1.0 - t) * corner[nodes] + t * corner[nodes + 1]);
  return sum < kInfinity ? sum : kInfinity;  // also 0 times infinity
}

double MotionCost::per_metre_in_cell(std::size_t cell, double c, double s) const {
  const GroundCell& ground = map_->cell(cell);
  const double cost = on_slope(ground.soil, c * ground.gradient_x + s * ground.gradient_y,
                               -s * ground.gradient_x + c * ground.gradient_y);
  return penalty_.empty() ? cost : cost * (1.0 + penalty_[cell]);
}

double MotionCost::per_metre_at(const Eigen::Vector2d& place, const Eigen::Vector2d& heading) const {
  const long long index = map_->index_at(place.x(), place.y());
  if (index < 0) return kInfinity;
  const auto cell = static_cast<std::size_t>(index);
  if (!is_open(map_->cell(cell).passage)) return kInfinity;
  return per_metre_in_cell(cell, heading.x(), heading.y());
}

double MotionCost::per_metre(const Pose2& pose) const {
  if (!map_->may_stand(pose)) return kInfinity;
  return per_metre_at({pose.x_m, pose.y_m}, {std::cos(pose.yaw_rad), std::sin(pose.yaw_rad)});
}

double MotionCost::of_turn(double turned_rad) const {
  const double turn = std::abs(turned_rad);
  return turn * turn_cost_per_rad_ + (turn > kNoTurn_rad ? turn_cost_each_ : 0.0);
}

double MotionCost::of_bend(double turned_rad) const {
  const double turn = std::abs(turned_rad);
  return turn * turn_cost_per_rad_ + std::min(1.0, turn / kFullPause_rad) * turn_cost_each_;
}

double MotionCost::of(const Motion& motion, double step_m) const {
  double cost = of_turn(motion.first_turn_rad) + of_turn(motion.last_turn_rad);
  if (motion.length_m > 0.0) {
    const double step = step_m > 0.0 ? step_m : map_->cell_m();
    const int pieces = std::max(1, static_cast<int>(std::ceil(motion.length_m / step)));
    const double piece = motion.length_m / pieces;
    // From midpoint to midpoint by the chord of a piece, which has the heading between them; one rotation a
    // piece.
    const double half_sweep = 0.5 * motion.curvature_1_m * piece;
    const double chord = std::abs(half_sweep) < 1e-9 ? piece : piece * std::sin(half_sweep) / half_sweep;
    const Pose2 first = motion.at(0.5 * piece);
    const Eigen::Rotation2Dd half_turn(half_sweep);
    const Eigen::Matrix2d turn_half = half_turn.toRotationMatrix();
    Eigen::Vector2d place(first.x_m, first.y_m);
    Eigen::Vector2d heading(std::cos(first.yaw_rad), std::sin(first.yaw_rad));
    for (int k = 0; k < pieces; ++k) {
      const double per_metre = per_metre_at(place, heading);
      if (!(per_metre < kInfinity)) return kInfinity;
      cost += piece * per_metre;
      const Eigen::Vector2d between = turn_half * heading;
      place += chord * between;
      heading = turn_half * between;
    }
  }
  // The steps above are as long as a cell, keep-outs may be smaller, and a turn in place sweeps the body's
  // corners beyond both of its ends: keep-outs are asked about the whole motion.
  return map_->may_stand(motion.to) && !map_->keep_out().hits_along(motion) ? cost : kInfinity;
}

}  // namespace slipway::planner
