#pragma once

#include <functional>
#include <vector>

#include "planner/search/leg_search.h"

namespace slipway::planner {

// Where the piece of a way that begins at a place ends: some 200 m on.
std::size_t piece_end(const std::vector<Eigen::Vector2d>& way, std::size_t begin);

// The grid's way of a leg as motions, in time that grows with its length alone: piece by piece it is pulled
// straight and smoothed, or driven from cell to cell where neither can be driven; then the joints of the
// pieces are smoothed. Empty where it was cancelled or a piece can't be driven.
std::vector<Motion> drive_long_way(const LegSearch& leg);

// The same of poses that a planner found.
std::vector<Motion> smooth_long_leg(const MotionCost& cost, const std::vector<Pose2>& poses,
                                    bool keep_last_heading, const std::function<bool()>& cancelled);

}  // namespace slipway::planner
