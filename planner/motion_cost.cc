#include "planner/motion_cost.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/angle.h"

namespace slipway::planner {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kAttitudeStep_rad = rad_from_deg(1.0);
constexpr double kJoulesPer100Wh = 360'000.0;
constexpr double kSteepFrom = 0.75;  // of a limit
constexpr double kMostSlip = 0.95;   // of the duration's 1 / (1 - slip)
// A turn in place is not only its turning: the wheels are steered first and straightened after.
constexpr double kSteeringPause_s = 20.0;
constexpr double kFullPause_rad = rad_from_deg(30.0);
constexpr double kNoTurn_rad = rad_from_deg(0.5);

double normal_tail(double z) { return 0.5 * std::erfc(z / std::sqrt(2.0)); }

// The probability that slip is over its limit.
double probability_over(double limit, double mean_slip, double weak_slip) {
  const double slip = std::max(mean_slip, 1e-3);
  const double spread = std::log(std::max(weak_slip, slip) / slip);
  if (spread < 1e-6) return slip > limit ? 1.0 : 0.0;
  return normal_tail(std::log(limit / slip) / spread);
}

// 1 up to 3/4 of the limit, 11 at it, on with the parabola.
double steepness(double share_of_limit) {
  const double over = std::max(0.0, share_of_limit - kSteepFrom) / (1.0 - kSteepFrom);
  return 1.0 + 10.0 * over * over;
}

double share_of_limits(const sim::DriveLimits& limits, const sim::TableEntry& entry, double tilt_rad) {
  return std::max({std::abs(entry.slip_ratio) / limits.max_slip_ratio, entry.current_a / limits.max_current_a,
                   entry.sinkage_m / limits.max_sinkage_m, tilt_rad / limits.max_tilt_rad});
}

}  // namespace

MotionCost::MotionCost(const PlanProblem& problem, const TraverseMap& map, const GroundTables& tables,
                       const Weights& weights)
    : map_(&map), limits_(motion_limits(*problem.rover)) {
  limit_rad_ = tables.unknown->mean.limit_rad();
  nodes_ = 2 * static_cast<int>(std::ceil(limit_rad_ / kAttitudeStep_rad)) + 1;
  kinds_ = tables.known.size() + 1;
  per_attitude_.reserve(kinds_ * static_cast<std::size_t>(nodes_) * static_cast<std::size_t>(nodes_));
  for (const std::optional<GroundTable>& table : tables.known) tabulate(problem, *table, false, weights);
  tabulate(problem, *tables.unknown, true, weights);
  const double level_w = tables.unknown->mean.at(0.0, 0.0)->energy_j_m * limits_.cruise_speed_m_s;
  const double per_second = weights.duration / 3600.0 + weights.energy * level_w / kJoulesPer100Wh;
  turn_cost_per_rad_ = per_second / limits_.turn_rate_rad_s;
  turn_cost_each_ = weights.duration / 3600.0 * kSteeringPause_s;
}

void MotionCost::tabulate(const PlanProblem& problem, const GroundTable& table, bool unknown,
                          const Weights& weights) {
  const double step = 2.0 * limit_rad_ / (nodes_ - 1);
  for (int i = 0; i < nodes_; ++i) {
    for (int j = 0; j < nodes_; ++j) {
      const double pitch = std::clamp(-limit_rad_ + i * step, -limit_rad_, limit_rad_);
      const double roll = std::clamp(-limit_rad_ + j * step, -limit_rad_, limit_rad_);
      const sim::TableEntry mean = *table.mean.at(pitch, roll);
      const sim::TableEntry weak = *table.weak.at(pitch, roll);
      if (mean.immobile > 0.5) {
        per_attitude_.push_back(std::numeric_limits<float>::infinity());
        continue;
      }
      const bool take_weak = unknown && weak.immobile <= 0.5;
      const sim::TableEntry& entry = take_weak ? weak : mean;
      const double slip = std::clamp(entry.slip_ratio, 0.0, kMostSlip);
      const double over = weak.immobile > 0.5
                              ? probability_over(problem.limits.max_slip_ratio, mean.slip_ratio, 1.0)
                              : probability_over(problem.limits.max_slip_ratio, mean.slip_ratio, weak.slip_ratio);
      const double sum = weights.duration / 3600.0 / (limits_.cruise_speed_m_s * (1.0 - slip)) +
                         weights.energy * entry.energy_j_m / kJoulesPer100Wh + weights.slip * slip / 100.0 +
                         (unknown ? weights.unknown / 100.0 : 0.0) +
                         weights.risk * over / std::max(table.correlation_length_m, 1.0);
      const double tilt = Attitude{.roll_rad = roll, .pitch_rad = pitch, .yaw_rad = 0.0}.tilt_rad();
      per_attitude_.push_back(
          static_cast<float>(sum * steepness(share_of_limits(problem.limits, entry, tilt))));
    }
  }
}

double MotionCost::on_attitude(std::uint8_t soil, double uphill, double leftward_rise) const {
  // R_MB = Rz(yaw) Ry(pitch) Rx(roll) on the plane: pitch is positive nose down, roll positive left side up.
  const double pitch = -std::atan(uphill);
  const double roll =
      std::asin(leftward_rise / std::sqrt(1.0 + uphill * uphill + leftward_rise * leftward_rise));
  if (std::abs(pitch) > limit_rad_ || std::abs(roll) > limit_rad_) return kInfinity;
  const double scale = (nodes_ - 1) / (2.0 * limit_rad_);
  const double row = (pitch + limit_rad_) * scale;
  const double column = (roll + limit_rad_) * scale;
  const int i = std::min(static_cast<int>(row), nodes_ - 2);
  const int j = std::min(static_cast<int>(column), nodes_ - 2);
  const std::size_t kind = soil == kUnknownSoil ? kinds_ - 1 : soil;
  const auto nodes = static_cast<std::size_t>(nodes_);
  const float* corner = &per_attitude_[(kind * nodes + static_cast<std::size_t>(i)) * nodes + j];
  const double t = column - j;
  const double u = row - i;
  const double sum = (1.0 - u) * ((1.0 - t) * corner[0] + t * corner[1]) +
                     u * ((1.0 - t) * corner[nodes] + t * corner[nodes + 1]);
  return std::isfinite(sum) ? sum : kInfinity;  // also 0 times infinity
}

double MotionCost::per_metre_in_cell(std::size_t cell, double c, double s) const {
  const GroundCell& ground = map_->cell(cell);
  const double cost = on_attitude(ground.soil, c * ground.gradient_x + s * ground.gradient_y,
                                  -s * ground.gradient_x + c * ground.gradient_y);
  return penalty_.empty() ? cost : cost * (1.0 + penalty_[cell]);
}

double MotionCost::per_metre(const Pose2& pose) const {
  if (!map_->may_stand(pose)) return kInfinity;
  const auto cell = static_cast<std::size_t>(map_->index_at(pose.x_m, pose.y_m));
  return per_metre_in_cell(cell, std::cos(pose.yaw_rad), std::sin(pose.yaw_rad));
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
  const double step = step_m > 0.0 ? step_m : map_->cell_m();
  const int pieces = std::max(1, static_cast<int>(std::ceil(motion.length_m / step)));
  const double piece = motion.length_m / pieces;
  for (int k = 0; k < pieces && cost < kInfinity; ++k) cost += piece * per_metre(motion.at((k + 0.5) * piece));
  // The body sweeps its corners where it turns: both ends of a turn must be free.
  if (cost < kInfinity && !map_->may_stand(motion.to)) return kInfinity;
  return cost == cost ? cost : kInfinity;  // 0 m of infinite cost
}

}  // namespace slipway::planner
