#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "planner/search/leg_search.h"

namespace slipway::planner {

// The cheapest way on the grid of cells (see GridSearch), pulled straight: of its cells those stay through
// which straights and turns in place cost least, and the last motion may be an arc into the heading of
// arrival. Without random numbers, so that it finds the same for every seed.
std::unique_ptr<LegPlanner> make_grid_planner();

// The grid's cheapest way of a leg from its beginning to its end. Empty where there is none.
std::vector<Eigen::Vector2d> places_along(const LegSearch& leg);

// What it does with the places of a way. Empty where nothing can be driven, or
// where it was cancelled.
std::vector<Pose2> pull_straight(const MotionCost& cost, const Pose2& from,
                                 const std::vector<Eigen::Vector2d>& places,
                                 const std::vector<double>& arrival_rad,
                                 const std::function<bool()>& cancelled);

}  // namespace slipway::planner
