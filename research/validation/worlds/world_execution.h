#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/result.h"
#include "planner/problem/problem.h"
#include "research/validation/worlds/seeded_world.h"
#include "sim/prediction/drive_prediction.h"

namespace slipway::validation {

// The problem of a world as planners are given it: its two maps, start, goal, and the rover's own limits. The
// slip is checked every 20 m, as on a blind drive: with a check every 5 m the rover halts before it digs
// itself in, and hardly any drive would be embedded. Planners differ in what they make of it.
planner::PlanProblem problem_of(const SeededWorld& world, std::shared_ptr<const sim::RoverModel> rover);

// Drives the stations `drives` times. The ground of each drive is another draw: each visible patch is of its
// class, each hidden one of a class drawn for the whole patch, each as likely as another, and about each
// class's mean in `soils` (by class) lies its spread. Drives of one seed meet the same grounds on every
// route. Stops, embedding, slip and time are by the model of predictions (sim::drawn_outcomes). Errors:
// no_data, where a station has no ground.
Result<std::vector<sim::DrawnOutcome>> execute(const SeededWorld& world, const planner::PlanProblem& problem,
                                               const std::vector<sim::SoilDistribution>& soils,
                                               std::span<const sim::PathStation> stations, int drives,
                                               std::uint64_t seed);

// The same on draws of what planners believe.
Result<std::vector<sim::DrawnOutcome>> execute_belief(const planner::PlanProblem& problem,
                                                      std::span<const sim::PathStation> stations, int drives,
                                                      std::uint64_t seed);

}  // namespace slipway::validation
