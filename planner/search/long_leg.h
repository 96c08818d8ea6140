#pragma once

#include <functional>
#include <vector>

#include "planner/search/motion_cost.h"

namespace slipway::planner {

// The grid's way from a pose as motions, in time that grows with its length alone: piece by piece of some
// 200 m it is pulled straight and smoothed, or driven from cell to cell where neither can be driven; then the
// joints of the pieces are smoothed. The first and the last place are the leg's own. Empty where it was
// cancelled or a piece can't be driven.
std::vector<Motion> drive_long_way(const MotionCost& cost, const Pose2& from,
                                   const std::vector<Eigen::Vector2d>& way,
                                   const std::vector<double>& arrival_rad,
                                   const std::function<bool()>& cancelled);

// The same of poses that a planner found.
std::vector<Motion> smooth_long_leg(const MotionCost& cost, const std::vector<Pose2>& poses,
                                    bool keep_last_heading, const std::function<bool()>& cancelled);

}  // namespace slipway::planner
