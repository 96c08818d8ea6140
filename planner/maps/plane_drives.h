#pragma once

#include <vector>

#include "planner/problem/problem.h"
#include "planner/problem/verdict.h"
#include "sim/prediction/drive_prediction.h"

namespace slipway::planner {

// A drive straight ahead on a plane of one kind of ground.
struct PlaneDrive {
  sim::OutcomeShares shares;
  // The largest share of a limit on the mean soils, 1 or more where one is broken; 2 where it is immobilised.
  double share_of_limits = 0.0;
};

// Such drives of one length by the plane's slope and the heading across it, predicted and judged as any other
// drive: so that a map of verdicts says what a check would. Between nodes the shares and their intervals are
// linear. The rover is taken to be the same on either side. Immutable.
class PlaneDrives {
 public:
  // `unknown`: ground that no map names.
  PlaneDrives(const PlanProblem& problem, const sim::SoilDistribution& belief, bool unknown,
              double distance_m);

  // Rise per metre ahead and to the left.
  PlaneDrive at(double uphill, double leftward) const;
  Verdict verdict(const PlaneDrive& drive) const;

 private:
  PlaneDrive drive_on(double uphill, double leftward) const;

  const PlanProblem& problem_;
  sim::SoilBeliefs beliefs_;
  bool unknown_;
  double distance_m_;
  double max_slope_rad_;
  int slopes_ = 0;
  std::vector<PlaneDrive> nodes_;  // slope by slope, of each all headings
};

}  // namespace slipway::planner
