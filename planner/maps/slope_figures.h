#pragma once

#include <optional>
#include <vector>

#include "planner/problem/problem.h"
#include "planner/search/ground_tables.h"

namespace slipway::planner {

// What driving does on a slope of one kind of ground.
struct SlopeFigures {
  double slip = 1.0;       // ratio on the mean soil, on unknown ground on its weak one; 1: it holds the rover
  double stop = 1.0;       // probability that a patch of the ground stops the rover: slip, current or hold
  double embedding = 1.0;  // that it embeds it
};

// Slopes steeper than this are not asked for: all figures are 1 there.
inline constexpr double kMaxMapSlope_rad = 0.61;  // 35 deg

// One kind of ground. Slip is the slip table's own. The probabilities are those of what a place may be: a
// soil of the belief (sim::likely_soils), and the error of slip that the belief states, normal in
//
//   ln(ln(1 - real slip) / ln(1 - slip))
//
// but never less than expected_metre() gives, whose log-normal spread has no least value, and 1 on slopes
// beyond the tilt limit. Of unknown ground they are at least sim::kWeakShare. Immutable.
class GroundOnSlopes {
 public:
  // The problem must outlive it. Without `with_risk` only slip is known.
  GroundOnSlopes(const PlanProblem& problem, const sim::SoilDistribution& belief, bool unknown,
                 bool with_risk);

  // Rise per metre ahead and to the left.
  SlopeFigures at(double uphill, double leftward) const;
  double slip_at(double uphill, double leftward) const;
  // Over a distance, each patch of the soil's correlation length by itself.
  double over(double distance_m, double of_patch) const;

 private:
  double correlation_length_m() const { return table_.correlation_length_m; }

  const PlanProblem& problem_;
  bool unknown_;
  double slip_error_;
  GroundTable table_;  // with all likely soils
};

// The least and the greatest of the figures over all headings, by the slope alone; linear between slopes.
class FiguresBySlope {
 public:
  explicit FiguresBySlope(const GroundOnSlopes& ground, bool with_risk);

  struct Range {
    SlopeFigures least, greatest;  // slip by its size
  };
  // slope: rise per metre.
  Range at(double slope) const;

 private:
  std::vector<Range> nodes_;
};

// The figures at headings by rise ahead and to the left; bilinear.
class FiguresByHeading {
 public:
  explicit FiguresByHeading(const GroundOnSlopes& ground);
  SlopeFigures at(double uphill, double leftward) const;

 private:
  int side_ = 0;
  std::vector<SlopeFigures> nodes_;
};

}  // namespace slipway::planner
