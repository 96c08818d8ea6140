#pragma once

#include <memory>
#include <vector>

#include "api/files/drive_outcomes.h"
#include "core/progress.h"
#include "core/result.h"
#include "planner/problem/problem.h"

namespace slipway::api {

// What drives of the past say of the draws of the ground.
struct GroundEvidence {
  std::shared_ptr<const std::vector<double>> weights;  // of draw d, with a mean of 1
  int drives = 0;                                      // that were used
  double effective_draws = 0.0;                        // (sum of the weights)^2 / sum of their squares
};

// The share of drives whose outcome a model calls wrongly though its ground is right: what it leaves out,
// rocks and ripples above all, stops drives too. Assumed.
inline constexpr double kModelError = 0.05;

// Where many drives leave few draws with any weight, the weights are flattened until this share is effective:
// the answer then leans less on them than it might, and never on a handful of draws.
inline constexpr double kMinEffective = 0.1;

// Weighs each draw by the probability of the outcomes of the drives before `as_of_sol` on its ground: 1 -
// kModelError where the draw stops as the drive did, or passes as it did, and kModelError where it does not
// [importance sampling, with the belief as its proposal]. Drives of which nothing is known count for nothing,
// those halted by something else as far as they came. Parts of their paths off the problem's terrain are left
// out. The problem's rover, limits, checks, seed and number of draws are those of the answer. Errors:
// cancelled.
Result<GroundEvidence> weigh_draws(const planner::PlanProblem& problem, const DriveOutcomeTable& table,
                                   int as_of_sol, Progress& progress);

// The corners of the drives before a sol, so that the ground under them is read too.
std::vector<planner::Waypoint> places_of(const DriveOutcomeTable& table, int as_of_sol);

}  // namespace slipway::api
