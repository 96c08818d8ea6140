#pragma once

#include <cstdint>
#include <vector>

#include "planner/search/leg_search.h"

namespace slipway::planner {

// A leg from a pose at `from` to `to`, with what suits its length: range, iterations and, where `to` has no
// heading, headings to arrive with.
LegSearch leg_between(const MotionCost& cost, const PoseSampler& sampler, const Pose2& at,
                      const Waypoint& from, const Waypoint& to, std::uint64_t seed,
                      std::function<bool()> cancelled);

// Poses that begin and end where the leg does: others would make a route with a leap in it.
bool joins(const std::vector<Pose2>& poses, const LegSearch& leg);

// Straight from place to place of the problem, in the headings that it asks for at them.
std::vector<Motion> straight_way(const PlanProblem& problem);

// Where nothing holds the start's heading, the rover is set down in the direction it leaves.
void set_down_as_it_leaves(const Waypoint& start, std::vector<Motion>& motions);

// All routes share the ground at the places they join: to be driven off it would only make a hook there.
bool is_near_place(const std::vector<Waypoint>& places, const Eigen::Vector2d& p, double reach_m);

}  // namespace slipway::planner
