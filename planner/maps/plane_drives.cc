#include "planner/maps/plane_drives.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/angle.h"
#include "core/parallel_for.h"
#include "planner/judge/drive_verdict.h"
#include "planner/judge/route_stations.h"

namespace slipway::planner {
namespace {

constexpr double kStep_rad = rad_from_deg(2.5);
constexpr int kHeadings = 7;              // from straight up to straight down
constexpr double kBeyondTilt_rad = 0.09;  // slopes beyond the limit of tilt that are looked at
constexpr double kImmobilised = 2.0;      // share of limits
constexpr int kMostDrawsOfNode = 272;     // the fewest without a case that show less than 1 %

class Plane final : public sim::Ground {
 public:
  Plane(double uphill, double leftward, bool unknown)
      : uphill_(uphill), leftward_(leftward), unknown_(unknown) {}

  std::optional<sim::GroundPoint> at(double x_m, double y_m) const override {
    return sim::GroundPoint{uphill_ * x_m + leftward_ * y_m,
                            Eigen::Vector3d(-uphill_, -leftward_, 1.0).normalized()};
  }
  std::optional<std::size_t> soil_at(double, double) const override {
    return unknown_ ? std::nullopt : std::optional<std::size_t>(0);
  }

 private:
  double uphill_, leftward_;
  bool unknown_;
};

double share_of_limits(const PlanProblem& problem, const sim::DrivePrediction& drive) {
  if (drive.immobilised) return kImmobilised;
  double largest = drive.max_slip_ratio.value / problem.limits.max_slip_ratio;
  const sim::StationRules rules(*problem.rover, problem.limits);
  for (const sim::StationPrediction& at : drive.stations)
    for (const sim::StationRules::Active& rule : rules.active())
      if (rule.row->trips == sim::Trips::kAbove && rule.row->rule != sim::Rule::kSuspension)
        largest = std::max(largest, rules.measure(rule, {}, at.state).value / rule.limit);
  return drive.broken_limits.empty() ? largest : std::max(1.0, largest);
}

sim::DrawnShare between(const sim::DrawnShare& a, const sim::DrawnShare& b, double t) {
  return {std::lerp(a.share, b.share, t), std::lerp(a.low, b.low, t), std::lerp(a.high, b.high, t)};
}

PlaneDrive between(const PlaneDrive& a, const PlaneDrive& b, double t) {
  return {{between(a.shares.stop, b.shares.stop, t), between(a.shares.immobilised, b.shares.immobilised, t),
           between(a.shares.embedding, b.shares.embedding, t)},
          std::lerp(a.share_of_limits, b.share_of_limits, t)};
}

PlaneDrive nowhere() {
  const sim::DrawnShare always{1.0, 1.0, 1.0};
  return {{always, always, always}, kImmobilised};
}

}  // namespace

PlaneDrives::PlaneDrives(const PlanProblem& problem, const sim::SoilDistribution& belief, bool unknown,
                         double distance_m)
    : problem_(problem),
      unknown_(unknown),
      distance_m_(distance_m),
      max_slope_rad_(problem.max_tilt_rad() + kBeyondTilt_rad) {
  beliefs_.unknown = belief;
  if (!unknown) beliefs_.known.push_back(belief);
  slopes_ = static_cast<int>(std::ceil(max_slope_rad_ / kStep_rad)) + 1;
  nodes_.resize(static_cast<std::size_t>(slopes_ * kHeadings));
  parallel_for(nodes_.size(), problem.threads, [&](std::size_t k) {
    const int slope = static_cast<int>(k) / kHeadings, heading = static_cast<int>(k) % kHeadings;
    if (slope == 0 && heading > 0) return;
    const double rise = std::tan(slope * kStep_rad);
    const double across = std::numbers::pi * heading / (kHeadings - 1);
    nodes_[k] = drive_on(rise * std::cos(across), rise * std::sin(across));
  });
  std::fill(nodes_.begin() + 1, nodes_.begin() + kHeadings, nodes_.front());
}

PlaneDrive PlaneDrives::drive_on(double uphill, double leftward) const {
  constexpr double kSpacing_m = 2.5, kMaxStations = 100.0;
  const Motion ahead{.from = {}, .to = {distance_m_, 0.0, 0.0}, .length_m = distance_m_};
  sim::RiskOptions risk = problem_.risk;
  risk.max_draws = std::min(risk.max_draws, kMostDrawsOfNode);
  risk.segment_m = 0.0;
  risk.relief = nullptr;
  NoProgress progress;
  const auto drive =
      sim::predict_drive(*problem_.rover, problem_.gravity_m_s2, Plane(uphill, leftward, unknown_), beliefs_,
                         route_stations({ahead}, std::max(kSpacing_m, distance_m_ / kMaxStations)),
                         problem_.limits, risk, 1, progress, problem_.conditions);
  if (!drive) return nowhere();
  return {drive->outcomes, share_of_limits(problem_, *drive)};
}

PlaneDrive PlaneDrives::at(double uphill, double leftward) const {
  const double slope = std::atan(std::hypot(uphill, leftward));
  if (!(slope <= max_slope_rad_)) return nowhere();
  const double across = std::abs(std::atan2(leftward, uphill));
  const double row = slope / kStep_rad, column = across / std::numbers::pi * (kHeadings - 1);
  const int i = std::min(static_cast<int>(row), slopes_ - 2);
  const int j = std::min(static_cast<int>(column), kHeadings - 2);
  const auto node = [&](int down, int right) -> const PlaneDrive& {
    return nodes_[static_cast<std::size_t>((i + down) * kHeadings + j + right)];
  };
  return between(between(node(0, 0), node(0, 1), column - j), between(node(1, 0), node(1, 1), column - j),
                 row - i);
}

Verdict PlaneDrives::verdict(const PlaneDrive& drive) const {
  if (drive.share_of_limits >= 1.0) return Verdict::kNoGo;
  const Verdict by_draws = judge_segment(problem_.risk.bars, drive.shares);
  return by_draws == Verdict::kNoGo && unknown_ ? Verdict::kUnknown : by_draws;
}

}  // namespace slipway::planner
