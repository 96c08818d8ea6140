#include "planner/search/metre.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/pose.h"

namespace slipway::planner {
namespace {

constexpr double kMaxSlip = 0.95;  // of the 1 / (1 - slip) of duration and way between checks

double normal_tail(double z) {
  return 0.5 * std::erfc(z / std::sqrt(2.0));
}

// The probability that a log-normal value is over a limit, from its median and the value one standard
// deviation weaker.
double probability_over(double limit, double median, double weak) {
  const double value = std::max(median, 1e-3);
  const double spread = std::log(std::max(weak, value) / value);
  if (spread < 1e-6) return value > limit ? 1.0 : 0.0;
  return normal_tail(std::log(limit / value) / spread);
}

// The probabilities of what may go wrong on a metre.
struct Mishaps {
  double over_limit = 0.0;  // slip, immobilised included
  double immobile = 0.0;
  double digging = 0.0;  // slip over embedding_slip_ratio, immobilised included
  double too_deep = 0.0;
};

double share_of_limits(const sim::DriveLimits& limits, const sim::TableEntry& entry,
                       const Attitude& attitude) {
  return std::max({std::abs(entry.slip_ratio) / limits.max_slip_ratio, entry.current_a / limits.max_current_a,
                   entry.sinkage_m / limits.max_sinkage_m, attitude.tilt_rad() / limits.max_tilt_rad,
                   std::abs(attitude.pitch_rad) / limits.max_pitch_rad,
                   std::abs(attitude.roll_rad) / limits.max_roll_rad,
                   std::abs(entry.side_slip_rad) / limits.max_side_slip_rad});
}

double embedding_sinkage_m(const PlanProblem& problem) {
  return problem.risk.checks.embedding_sinkage_share * problem.rover->smallest_wheel_radius_m();
}

DriveFigures figures_with(const PlanProblem& problem, const GroundTable& table, bool unknown,
                          const sim::TableEntry& entry, const Mishaps& mishaps) {
  const sim::SlipChecks& checks = problem.risk.checks;
  const double slip = std::clamp(entry.slip_ratio, 0.0, kMaxSlip);
  const double slip_at_check = std::clamp(std::max(slip, problem.limits.max_slip_ratio), 0.0, kMaxSlip);
  const double turn_m = 2.0 * std::numbers::pi * problem.rover->smallest_wheel_radius_m();
  const bool digs_in = checks.slip_check_every_m > checks.embedding_turns * turn_m;
  const double patch_m = std::max(table.correlation_length_m, 1.0);
  return {.length_m = 1.0,
          .duration_s = 1.0 / (problem.rover->cruise_speed_m_s * (1.0 - slip)),
          .energy_j = entry.energy_j_m,
          .slip_length_m = slip,
          .unknown_length_m = unknown ? 1.0 : 0.0,
          .expected_stops =
              (mishaps.over_limit - mishaps.immobile) / (checks.slip_check_every_m * (1.0 - slip_at_check)) +
              mishaps.immobile / sim::max_station_spacing_m(*problem.rover),
          .embedding = std::max(mishaps.too_deep, digs_in ? mishaps.digging : 0.0) / patch_m,
          .risk = mishaps.over_limit / patch_m};
}

}  // namespace

std::optional<Metre> expected_metre(const PlanProblem& problem, const GroundTable& table, bool unknown,
                                    double pitch_rad, double roll_rad) {
  const sim::TableEntry mean = *table.mean.at(pitch_rad, roll_rad);
  const sim::TableEntry weak = *table.weak.at(pitch_rad, roll_rad);
  if (mean.immobile) return std::nullopt;
  const sim::TableEntry& entry = unknown && !weak.immobile ? weak : mean;
  const double weak_slip = weak.immobile ? 1.0 : weak.slip_ratio;
  const auto slip_over = [&](double limit) { return probability_over(limit, mean.slip_ratio, weak_slip); };
  Mishaps mishaps{.over_limit = slip_over(problem.limits.max_slip_ratio),
                  .immobile = slip_over(1.0),
                  .digging = slip_over(problem.risk.checks.embedding_slip_ratio),
                  .too_deep = probability_over(embedding_sinkage_m(problem), mean.sinkage_m, weak.sinkage_m)};
  mishaps.immobile = std::min(mishaps.immobile, mishaps.over_limit);
  const Attitude attitude{.roll_rad = roll_rad + entry.roll_lean_rad,
                          .pitch_rad = pitch_rad + entry.pitch_lean_rad,
                          .yaw_rad = 0.0};
  return Metre{figures_with(problem, table, unknown, entry, mishaps),
               share_of_limits(problem.limits, entry, attitude)};
}

double tail_cost_of_metre(const PlanProblem& problem, const GroundTable& table, bool unknown,
                          double pitch_rad, double roll_rad, const Weights& weights, double tail) {
  std::vector<WeightedCost> costs;
  const sim::TableEntry mean = *table.mean.at(pitch_rad, roll_rad);
  for (const LikelyTable& likely : table.likely) {
    const sim::TableEntry entry = *likely.slip.at(pitch_rad, roll_rad);
    const double slip = entry.immobile ? 1.0 : entry.slip_ratio;
    const auto is = [](bool so) { return so ? 1.0 : 0.0; };
    const Mishaps mishaps{.over_limit = is(entry.immobile || slip > problem.limits.max_slip_ratio),
                          .immobile = is(entry.immobile),
                          .digging = is(slip > problem.risk.checks.embedding_slip_ratio),
                          .too_deep = is(entry.sinkage_m > embedding_sinkage_m(problem))};
    const sim::TableEntry& driven = entry.immobile ? mean : entry;
    costs.push_back({weights.cost(figures_with(problem, table, unknown, driven, mishaps)), likely.weight});
  }
  return conditional_value_at_risk(costs, tail);
}

}  // namespace slipway::planner
