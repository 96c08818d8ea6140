#include "planner/maps/slope_figures.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/angle.h"
#include "planner/search/ground_tables.h"
#include "sim/prediction/drawn_ground.h"

namespace slipway::planner {
namespace {

constexpr double kStep_rad = rad_from_deg(2.5);
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

}  // namespace

GroundOnSlopes::GroundOnSlopes(const PlanProblem& problem, const sim::SoilDistribution& belief, bool unknown,
                               std::optional<double> distance_m)
    : unknown_(unknown),
      slips_(*problem.rover, problem.gravity_m_s2, unknown ? weak_soil(belief) : belief.mean,
             kMaxMapSlope_rad, kStep_rad, problem.conditions) {
  if (distance_m) drives_.emplace(problem, belief, unknown, *distance_m);
}

double GroundOnSlopes::slip_at(double uphill, double leftward) const {
  const PitchRoll lie = on_plane(uphill, leftward);
  const auto entry = slips_.at(lie.pitch_rad, lie.roll_rad);
  return !entry || entry->immobile ? 1.0 : entry->slip_ratio;
}

SlopeFigures GroundOnSlopes::at(double uphill, double leftward) const {
  SlopeFigures figures{slip_at(uphill, leftward), 0.0, 0.0, 0.0};
  if (!drives_) return figures;
  const PlaneDrive drive = drives_->at(uphill, leftward);
  const double least = unknown_ ? sim::kWeakShare : 0.0;
  // Where the mean soil breaks a limit, more than half of the drives halt.
  figures.stop = std::max({drive.shares.stop.share, least, drive.share_of_limits >= 1.0 ? 0.5 : 0.0});
  figures.embedding = std::max(drive.shares.embedding.share, least);
  figures.severity = severity(drives_->verdict(drive));
  return figures;
}

FiguresBySlope::FiguresBySlope(const GroundOnSlopes& ground, bool with_risk) {
  const int nodes = static_cast<int>(std::lround(kMaxSlope / kSlopeNode)) + 1;
  nodes_.resize(static_cast<std::size_t>(nodes));
  for (int i = 0; i < nodes; ++i) {
    const double slope = i * kSlopeNode;
    Range& range = nodes_[static_cast<std::size_t>(i)];
    if (slope > std::tan(kMaxMapSlope_rad)) continue;
    range.greatest = {0.0, 0.0, 0.0, 0.0};
    const int headings = with_risk ? kRiskHeadings : kHeadings;
    for (int k = 0; k < headings; ++k) {
      const double way = 2.0 * std::numbers::pi * k / headings;
      const double uphill = slope * std::cos(way), leftward = slope * std::sin(way);
      const SlopeFigures at = with_risk ? ground.at(uphill, leftward)
                                        : SlopeFigures{ground.slip_at(uphill, leftward), 0.0, 0.0, 0.0};
      const auto widen = [&](double SlopeFigures::*figure) {
        const double value = std::abs(at.*figure);
        range.least.*figure = std::min(range.least.*figure, value);
        range.greatest.*figure = std::max(range.greatest.*figure, value);
      };
      widen(&SlopeFigures::slip);
      widen(&SlopeFigures::stop);
      widen(&SlopeFigures::embedding);
      widen(&SlopeFigures::severity);
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
                        a.embedding + t * (b.embedding - a.embedding), t < 0.5 ? a.severity : b.severity};
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
  SlopeFigures sum{0.0, 0.0, 0.0, 0.0};
  for (const int down : {0, 1}) {
    for (const int right : {0, 1}) {
      const double weight =
          (down == 1 ? row - i : 1.0 - (row - i)) * (right == 1 ? column - j : 1.0 - (column - j));
      const SlopeFigures& node = nodes_[static_cast<std::size_t>(i + down) * static_cast<std::size_t>(side_) +
                                        static_cast<std::size_t>(j + right)];
      sum.slip += weight * node.slip;
      sum.stop += weight * node.stop;
      sum.embedding += weight * node.embedding;
      if (weight > 0.0) sum.severity = std::max(sum.severity, node.severity);
    }
  }
  return sum;
}

}  // namespace slipway::planner
