#pragma once

#include <optional>
#include <vector>

#include "planner/maps/plane_drives.h"
#include "planner/problem/problem.h"
#include "sim/quasi_static/slip_table.h"

namespace slipway::planner {

// What driving does on a slope of one kind of ground.
struct SlopeFigures {
  double slip = 1.0;       // ratio on the mean soil, on unknown ground on its weak one; 1: it holds the rover
  double stop = 1.0;       // probability of a halt on a drive of the map's distance
  double embedding = 1.0;  // of an embedding before that
  double severity = 2.0;   // of the verdict: 0 GO, 1 UNKNOWN, 2 NO-GO
};

// Slopes steeper than this are not asked for: all figures are the worst there.
inline constexpr double kMaxMapSlope_rad = 0.61;  // 35 deg

// One kind of ground. Slip is the slip table's own; the probabilities are those of drives on planes. Of
// unknown ground they are at least sim::kWeakShare. Immutable.
class GroundOnSlopes {
 public:
  // The problem must outlive it. Without a `distance_m` only slip is known.
  GroundOnSlopes(const PlanProblem& problem, const sim::SoilDistribution& belief, bool unknown,
                 std::optional<double> distance_m);

  // Rise per metre ahead and to the left.
  SlopeFigures at(double uphill, double leftward) const;
  double slip_at(double uphill, double leftward) const;

 private:
  bool unknown_;
  sim::SlipTable slips_;
  std::optional<PlaneDrives> drives_;
};

// The least and the greatest of the figures over all headings, by the slope alone; linear between slopes.
class FiguresBySlope {
 public:
  explicit FiguresBySlope(const GroundOnSlopes& ground, bool with_risk);

  struct Range {
    SlopeFigures least, greatest;  // slip by its size; the severity's between nodes is the nearer node's
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
