#pragma once

#include <cstdint>
#include <functional>
#include <string_view>
#include <vector>

#include "planner/search/motion_cost.h"
#include "planner/search/pose_sampler.h"

namespace slipway::planner {

// One search by one planner of OMPL between two places.
struct LegSearch {
  const MotionCost* cost = nullptr;
  const PoseSampler* sampler = nullptr;
  Pose2 from;
  double to_x_m = 0.0;
  double to_y_m = 0.0;
  std::vector<double> arrival_rad;  // headings that will do; with one, it is kept exactly
  std::uint64_t seed = 1;
  int iterations = 2000;
  double range_m = 12.0;  // longest motion
  std::function<bool()> cancelled;
};

// The poses of the cheapest route found, from and to included; empty where none was found or the search was
// cancelled. `planner` is a name of the catalogue. The same search gives the same poses in any process and
// thread.
std::vector<Pose2> search_leg(std::string_view planner, const LegSearch& search);

}  // namespace slipway::planner
