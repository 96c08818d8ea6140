#include "planner/maps/slope_figures.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/angle.h"
#include "core/parallel_for.h"
#include "planner/search/metre.h"
#include "sim/prediction/likely_soils.h"

namespace slipway::planner {
namespace {

constexpr std::size_t kLikelySoils = 40;
constexpr double kStep_rad = rad_from_deg(2.5);
constexpr double kLikelyNodesToLimit = 4.0;
constexpr int kHeadings = 72;      // of slip
constexpr int kRiskHeadings = 24;  // of probabilities, which take longer
constexpr double kSlopeNode = 0.0025, kHeadingNode = 0.01;
constexpr double kMaxSlope = 0.70;  // tan of kMaxMapSlope_rad

struct PitchRoll {
  double pitch_rad, roll_rad;
};

// R_MB = Rz(yaw) Ry(pitch) Rx(roll) on the plane, as in MotionCost.
PitchRoll on_plane(double uphill, double leftward) {
  return {-std::atan(uphill), std::asin(leftward / std::sqrt(1.0 + uphill * uphill + leftward * leftward))};
}

double normal_tail(double z) {
  return 0.5 * std::erfc(z / std::numbers::sqrt2);
}

// The probability that the real slip is over a limit where the model's is this.
double slip_over(double limit, const sim::TableEntry& entry, double slip_error) {
  if (entry.immobile) return 1.0;
  const double slip = std::clamp(entry.slip_ratio, 1e-4, 1.0 - 1e-9);
  if (limit >= 1.0) return 0.0;
  if (slip_error <= 0.0) return slip > limit ? 1.0 : 0.0;
  return normal_tail(std::log(std::log1p(-limit) / std::log1p(-slip)) / slip_error);
}

}  // namespace

GroundOnSlopes::GroundOnSlopes(const PlanProblem& problem, const sim::SoilDistribution& belief, bool unknown,
                               bool with_risk)
    : problem_(problem),
      unknown_(unknown),
      slip_error_(belief.slip_error),
      table_{sim::SlipTable(*problem.rover, problem.gravity_m_s2, belief.mean, kMaxMapSlope_rad, kStep_rad,
                            problem.conditions),
             sim::SlipTable(*problem.rover, problem.gravity_m_s2, weak_soil(belief), kMaxMapSlope_rad,
                            kStep_rad, problem.conditions),
             belief.correlation_length_m,
             {}} {
  if (!with_risk) return;
  const sim::LevelGroundTest drives_level(*problem.rover, problem.gravity_m_s2);
  const std::vector<sim::LikelySoil> soils = sim::likely_soils(belief, kLikelySoils, drives_level);
  std::vector<std::optional<sim::SlipTable>> tables(soils.size());
  parallel_for(soils.size(), problem.threads, [&](std::size_t i) {
    tables[i].emplace(*problem.rover, problem.gravity_m_s2, soils[i].soil, problem.max_tilt_rad(),
                      problem.max_tilt_rad() / kLikelyNodesToLimit, problem.conditions);
  });
  double sum = 0.0;
  for (const sim::LikelySoil& soil : soils) sum += soil.weight;
  for (std::size_t i = 0; i < soils.size(); ++i)
    table_.likely.push_back({std::move(*tables[i]), soils[i].weight / sum});
}

double GroundOnSlopes::slip_at(double uphill, double leftward) const {
  const PitchRoll lie = on_plane(uphill, leftward);
  const auto entry = (unknown_ ? table_.weak : table_.mean).at(lie.pitch_rad, lie.roll_rad);
  return !entry || entry->immobile ? 1.0 : entry->slip_ratio;
}

SlopeFigures GroundOnSlopes::at(double uphill, double leftward) const {
  const PitchRoll lie = on_plane(uphill, leftward);
  SlopeFigures figures{slip_at(uphill, leftward), 0.0, 0.0};
  const sim::SlipChecks& checks = problem_.risk.checks;
  const double wheel_m = problem_.rover->smallest_wheel_radius_m();
  const bool digs_in = checks.slip_check_every_m > checks.embedding_turns * 2.0 * std::numbers::pi * wheel_m;
  for (const LikelyTable& likely : table_.likely) {
    const auto entry = likely.slip.at(lie.pitch_rad, lie.roll_rad);
    if (!entry) return {figures.slip, 1.0, 1.0};  // steeper than the tilt limit
    const bool stalls = entry->current_a > problem_.limits.max_current_a;
    const bool too_deep = entry->sinkage_m > checks.embedding_sinkage_share * wheel_m;
    figures.stop +=
        likely.weight * (stalls ? 1.0 : slip_over(problem_.limits.max_slip_ratio, *entry, slip_error_));
    figures.embedding +=
        likely.weight *
        (too_deep ? 1.0 : (digs_in ? slip_over(checks.embedding_slip_ratio, *entry, slip_error_) : 0.0));
  }
  const auto metre = expected_metre(problem_, table_, unknown_, lie.pitch_rad, lie.roll_rad);
  const double patch_m = std::max(correlation_length_m(), 1.0);
  // Where the mean soil holds the rover, half of the soils do.
  figures.stop = std::clamp(std::max(figures.stop, metre ? metre->figures.risk * patch_m : 0.5), 0.0, 1.0);
  figures.embedding =
      std::clamp(std::max(figures.embedding, metre ? metre->figures.embedding * patch_m : 0.0), 0.0, 1.0);
  if (!unknown_) return figures;
  figures.stop = std::max(figures.stop, sim::kWeakShare);
  figures.embedding = std::max(figures.embedding, sim::kWeakShare);
  return figures;
}

double GroundOnSlopes::over(double distance_m, double of_patch) const {
  const double patches = std::max(1.0, distance_m / std::max(correlation_length_m(), 1.0));
  return of_patch >= 1.0 ? 1.0 : -std::expm1(patches * std::log1p(-of_patch));
}

FiguresBySlope::FiguresBySlope(const GroundOnSlopes& ground, bool with_risk) {
  const int nodes = static_cast<int>(std::lround(kMaxSlope / kSlopeNode)) + 1;
  nodes_.resize(static_cast<std::size_t>(nodes));
  for (int i = 0; i < nodes; ++i) {
    const double slope = i * kSlopeNode;
    Range& range = nodes_[static_cast<std::size_t>(i)];
    if (slope > std::tan(kMaxMapSlope_rad)) continue;
    range.greatest = {0.0, 0.0, 0.0};
    const int headings = with_risk ? kRiskHeadings : kHeadings;
    for (int k = 0; k < headings; ++k) {
      const double way = 2.0 * std::numbers::pi * k / headings;
      const double uphill = slope * std::cos(way), leftward = slope * std::sin(way);
      const SlopeFigures at =
          with_risk ? ground.at(uphill, leftward) : SlopeFigures{ground.slip_at(uphill, leftward), 0.0, 0.0};
      const auto widen = [&](double SlopeFigures::*figure) {
        const double value = std::abs(at.*figure);
        range.least.*figure = std::min(range.least.*figure, value);
        range.greatest.*figure = std::max(range.greatest.*figure, value);
      };
      widen(&SlopeFigures::slip);
      widen(&SlopeFigures::stop);
      widen(&SlopeFigures::embedding);
    }
  }
}

FiguresBySlope::Range FiguresBySlope::at(double slope) const {
  const double place = slope / kSlopeNode;
  if (!(place < static_cast<double>(nodes_.size() - 1))) return {};
  const auto i = static_cast<std::size_t>(place);
  const double t = place - static_cast<double>(i);
  const auto between = [t](const SlopeFigures& a, const SlopeFigures& b) {
    return SlopeFigures{a.slip + t * (b.slip - a.slip), a.stop + t * (b.stop - a.stop),
                        a.embedding + t * (b.embedding - a.embedding)};
  };
  return {between(nodes_[i].least, nodes_[i + 1].least), between(nodes_[i].greatest, nodes_[i + 1].greatest)};
}

FiguresByHeading::FiguresByHeading(const GroundOnSlopes& ground)
    : side_(2 * static_cast<int>(std::lround(kMaxSlope / kHeadingNode)) + 1) {
  for (int i = 0; i < side_; ++i) {
    for (int j = 0; j < side_; ++j) {
      const double uphill = i * kHeadingNode - kMaxSlope, leftward = j * kHeadingNode - kMaxSlope;
      const bool within = std::hypot(uphill, leftward) <= std::tan(kMaxMapSlope_rad);
      nodes_.push_back(within ? ground.at(uphill, leftward) : SlopeFigures{});
    }
  }
}

SlopeFigures FiguresByHeading::at(double uphill, double leftward) const {
  const double row = (uphill + kMaxSlope) / kHeadingNode, column = (leftward + kMaxSlope) / kHeadingNode;
  if (!(row >= 0.0 && column >= 0.0 && row < side_ - 1 && column < side_ - 1)) return {};
  const int i = static_cast<int>(row), j = static_cast<int>(column);
  SlopeFigures sum{0.0, 0.0, 0.0};
  for (const int down : {0, 1}) {
    for (const int right : {0, 1}) {
      const double weight =
          (down == 1 ? row - i : 1.0 - (row - i)) * (right == 1 ? column - j : 1.0 - (column - j));
      const SlopeFigures& node = nodes_[static_cast<std::size_t>(i + down) * static_cast<std::size_t>(side_) +
                                        static_cast<std::size_t>(j + right)];
      sum.slip += weight * node.slip;
      sum.stop += weight * node.stop;
      sum.embedding += weight * node.embedding;
    }
  }
  return sum;
}

}  // namespace slipway::planner
