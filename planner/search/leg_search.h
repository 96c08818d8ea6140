#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "planner/search/motion_cost.h"
#include "planner/search/pose_sampler.h"

namespace slipway::planner {

// Of the random numbers that propose routes, for every plan: a request's own seed draws the ground alone, so
// that another draw of the ground is judged on the same candidates.
constexpr std::uint64_t kProposalSeed = 1;

// One leg: what a planner is given to get from one place to the next.
struct LegSearch {
  const MotionCost* cost = nullptr;
  const PoseSampler* sampler = nullptr;  // where to look, with the grid's cheapest way
  Pose2 from;
  double to_x_m = 0.0;
  double to_y_m = 0.0;
  std::vector<double> arrival_rad;  // headings that will do, in (-pi, pi]; with one, it is kept exactly
  std::uint64_t seed = 1;
  int iterations = 2000;
  double range_m = 12.0;  // longest motion
  std::function<bool()> cancelled;
};

// A way to search one leg. What it finds is joined by connect(), smoothed and held against every limit after,
// so a planner may be of any kind; a route of infinite cost is dropped.
class LegPlanner {
 public:
  virtual ~LegPlanner() = default;
  // The poses of the cheapest route found, from and to included; empty where none was found or the search was
  // cancelled. The same search gives the same poses in any process and thread; called from several threads.
  virtual std::vector<Pose2> search(const LegSearch& leg) const = 0;
};

}  // namespace slipway::planner
